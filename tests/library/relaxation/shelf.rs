//! The endless shelf, whose radiosities are known.

#[path = "../../../examples/common/shelf.rs"]
mod published;

use radiosity::colour::Rgb;

use super::{EXACT, METHODS, distance, relax};

#[test]
fn the_endless_shelf_is_as_bright_as_published() {
    let sqrt3 = 3_f64.sqrt();
    let factors = published::form_factors();
    for ((from, to), exact) in [
        ((0, 1), (sqrt3 - 1.0) / 2.0),
        ((0, 2), 2.0 - sqrt3),
        ((1, 0), (1.0 - 1.0 / sqrt3) / 2.0),
        ((1, 2), (1.0 - 1.0 / sqrt3) / 2.0),
        ((2, 0), 2.0 - sqrt3),
        ((2, 1), (sqrt3 - 1.0) / 2.0),
    ] {
        assert!((factors.get(from, to) - exact).abs() < 1e-14, "{from} to {to}");
    }
    let exact = [
        [1.0, 0.116603033208078, 0.103542954914533],
        [1.00709233938296, 0.117430021492673, 0.104277316691502],
        [0.211324865405187, 1.0, 0.211324865405187],
        [1.04646906279798, 1.02905716614702, 0.328530802518553],
    ];
    // The lecture's slips: 0.21133 twice, and 0.02906.
    let slips = [(2, 0), (2, 2), (3, 1)];
    for (number, (row, exact)) in published::ROWS.iter().zip(exact).enumerate() {
        let system = row.system().unwrap();
        let truth = exact.map(Rgb::splat);
        assert!(distance(&system.solve_directly().unwrap(), &truth) < 1e-13);
        for method in METHODS {
            let radiosity = relax(&system, method, 1.0, &EXACT).radiosity;
            assert!(distance(&radiosity, &truth) < 1e-10, "{method:?}");
        }
        for (strip, (printed, exact)) in row.printed.iter().zip(exact).enumerate() {
            let is_right = (printed - exact).abs() <= 0.5e-5;
            assert_eq!(is_right, !slips.contains(&(number, strip)), "row {number}, {strip}");
        }
    }
}
