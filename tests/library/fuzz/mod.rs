//! No input may break the program: seeds are bent by the rules of their formats, loaded, and what loads
//! is solved.
//!
//! `cargo test fuzz::` takes seconds; `cargo test fuzz:: -- --ignored` takes `FUZZ_SECONDS`
//! (default 60) for each target, from seed `FUZZ_SEED` on. What fails is left in
//! `target/tmp/fuzz-TARGET-SEED`.

mod bend;
mod corpus;
mod run;
mod targets;

use std::env;
use std::time::Duration;

use run::{Target, fuzz};

/// Few cases, the same each time.
fn quickly(target: &Target) {
    fuzz(target, 0..target.quick, Duration::MAX);
}

/// As many as time allows.
fn for_long(target: &Target) {
    let number = |name: &str| env::var(name).ok().and_then(|text| text.parse().ok());
    let first = number("FUZZ_SEED").unwrap_or(1_000_000);
    fuzz(target, first..u64::MAX, Duration::from_secs(number("FUZZ_SECONDS").unwrap_or(60)));
}

macro_rules! tests {
    ($($name:ident: $target:ident;)*) => {
        $(#[test]
        fn $name() {
            quickly(&targets::$target);
        })*

        mod long {
            $(#[test]
            #[ignore = "takes as long as FUZZ_SECONDS says"]
            fn $name() {
                super::for_long(&super::targets::$target);
            })*
        }
    };
}

tests! {
    bent_obj_files: OBJ;
    bent_mtl_files: MTL;
    bent_gltf_files: GLTF;
    bent_glb_files: GLB;
    bent_compressed_files: PACKED;
    bent_stl_files: STL;
    bent_ply_files: PLY;
    bent_configurations: TOML;
    bent_luminaires: IES;
    bent_scenes_are_solved: SOLVED;
}
