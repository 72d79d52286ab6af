//! The same scene and settings give the same bytes, whatever the number of threads, and however often the work
//! was left and taken up again.

use std::ops::ControlFlow;
use std::path::Path;

use crate::common::{self, coarse, mesh_of, shipped};
use radiosity::solver::{Cancellation, Checkpoint, Stop};
use radiosity::{
    Length, Plan, Settings, Solution, Surfaces, TriMesh, reconstruct, solve_with, surfaces_of,
};
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

/// Solves until the observer has been told so many times, keeping work in a file and going on from it.
fn solve_for(
    (surfaces, settings): (&Surfaces, &Settings),
    path: &Path,
    patience: usize,
) -> radiosity::Result<Solution> {
    let mut checkpoint = if path.exists() {
        Checkpoint::resume(path, surfaces, settings)
    } else {
        Checkpoint::create(path, surfaces, settings)
    }?;
    let mut told = 0;
    let observe = |_: &radiosity::solver::Progress| {
        told += 1;
        if told > patience {
            ControlFlow::Break(Cancellation::Caller)
        } else {
            ControlFlow::Continue(())
        }
    };
    let plan = Plan { checkpoint: Some(&mut checkpoint), ..Plan::default() };
    let solution = solve_with(surfaces, settings, plan, observe)?.0;
    assert!(checkpoint.failure().is_none());
    Ok(solution)
}

/// Everything that is told of a solution, and its light to the last bit.
fn account(surfaces: &Surfaces, solution: &Solution) -> (String, (Vec<u64>, Vec<u32>)) {
    let Solution { energy, stop, shots, hemicubes, work, history, .. } = solution;
    let told = format!("{energy:?} {stop:?} {shots} {hemicubes:?} {work:?} {history:?}");
    (told, bits(&reconstruct(surfaces, solution)))
}

#[test]
fn work_that_is_left_and_taken_up_again_ends_in_the_same_bytes() {
    let scene = shipped("cornell-box.obj");
    let surfaces = surfaces_of(&scene);
    let patch_size = Length::OfScene(1.0 / 8.0);
    for method in [radiosity::settings::Method::Progressive, radiosity::settings::Method::Jacobi] {
        let settings = Settings { tolerance: 0.1, max_level: 3, patch_size, method, ..coarse() };
        let whole = account(&surfaces, &common::solve(&surfaces, &settings));
        let directory = tempfile::tempdir().unwrap();
        for patience in [0, 9] {
            let path = directory.path().join(format!("{method:?}{patience}"));
            let mut runs = 0;
            let end = loop {
                runs += 1;
                // Each run comes a little further, in every phase of the work.
                let patience = patience + 2 * runs * runs * runs;
                let solution = solve_for((&surfaces, &settings), &path, patience).unwrap();
                if solution.stop == Stop::Converged {
                    break solution;
                }
            };
            assert!(runs > 2, "{runs} runs");
            assert!(account(&surfaces, &end) == whole, "{method:?}, left every {patience}");
            let again = solve_for((&surfaces, &settings), &path, usize::MAX).unwrap();
            assert!(account(&surfaces, &again) == whole, "{method:?}, from the end");
        }
    }
}

#[test]
fn a_checkpoint_serves_only_the_scene_and_the_settings_it_was_made_for() {
    let surfaces = surfaces_of(&shipped("cornell-box.obj"));
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("work");
    let resume = |surfaces: &Surfaces, settings: &Settings| {
        Checkpoint::resume(&path, surfaces, settings).map(|_| ()).map_err(|e| e.to_string())
    };
    assert!(resume(&surfaces, &coarse()).is_err(), "there is no file");
    Checkpoint::create(&path, &surfaces, &coarse()).unwrap();
    assert!(Checkpoint::create(&path, &surfaces, &coarse()).is_err(), "nothing is overwritten");
    resume(&surfaces, &Settings { max_elements: Some(7), ..coarse() }).unwrap();
    let other = Settings { tolerance: coarse().tolerance * 2.0, ..coarse() };
    assert!(resume(&surfaces, &other).unwrap_err().contains("settings"));
    let mut brighter = surfaces.clone();
    brighter.list[0].reflectance *= 0.999_999;
    assert!(resume(&brighter, &coarse()).unwrap_err().contains("another scene"));
    std::fs::write(&path, "no checkpoint").unwrap();
    assert!(resume(&surfaces, &coarse()).unwrap_err().contains("not the checkpoint"));
    assert_eq!(std::fs::read(&path).unwrap(), b"no checkpoint");
}
