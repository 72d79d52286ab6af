//! The same scene and settings give the same bytes, whatever the number of threads.

mod common;

use common::{coarse, mesh_of, shipped};
use radiosity::{Length, Settings, TriMesh};
use rayon::ThreadPoolBuilder;

/// All that the triangle mesh is made of, as bits.
fn bits(mesh: &TriMesh) -> (Vec<u64>, Vec<u32>) {
    let reals = mesh.positions.iter().chain(&mesh.radiosity).flat_map(|v| v.to_array());
    let singles = mesh.normals.iter().flat_map(|n| n.to_array());
    let corners = mesh.triangles.iter().flatten().copied();
    (reals.map(f64::to_bits).collect(), singles.map(f32::to_bits).chain(corners).collect())
}

#[test]
fn one_two_and_five_threads_agree_bit_for_bit() {
    let scene = shipped("cornell-box.obj");
    let patch_size = Length::OfScene(1.0 / 10.0);
    let settings = Settings { tolerance: 0.06, max_level: 4, patch_size, ..coarse() };
    let [one, two, five] = [1, 2, 5].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        bits(&pool.install(|| mesh_of(&scene, &settings)))
    });
    assert!(!one.0.is_empty());
    assert!(one == two, "one and two threads differ");
    assert!(one == five, "one and five threads differ");
}

#[test]
fn a_second_run_agrees_bit_for_bit() {
    let scene = shipped("office.obj");
    let settings = Settings { max_level: 1, ..coarse() };
    let [first, second] = [(); 2].map(|()| bits(&mesh_of(&scene, &settings)));
    assert!(first == second, "two runs differ");
}
