//! Luminaires from IES files.

use std::f64::consts::PI;

use glam::DVec3;
use proptest::prelude::*;
use radiosity::Scene;
use radiosity::scene::{Light, Photometry};

/// A file with these figures after `TILT=NONE`.
fn added(text: &str) -> Result<Scene, String> {
    let directory = tempfile::tempdir().expect("temporary directories can be made");
    let path = directory.path().join("lamp.ies");
    std::fs::write(&path, text).expect("temporary files can be written");
    let mut scene = Scene::default();
    let added = scene.add_luminaire(&path, DVec3::ZERO, 0.0);
    added.map(|()| scene).map_err(|error| error.to_string())
}

fn photometry(text: &str) -> Photometry {
    match added(text).expect("the file is right").lights.remove(0).light {
        Light::Luminaire { photometry, .. } => Photometry::clone(&photometry),
        light => panic!("{light:?}"),
    }
}

const EVEN: &str = "IESNA:LM-63-2002\n[TEST] x\n[LUMINAIRE] Ball\nTILT=NONE\n\
                    1 2000 2 3 1 1 2 0 0 0\n0.5 1 60\n0 90 180\n0\n100 100 100\n";

#[test]
fn an_even_luminaire_sends_four_pi_times_its_candela() {
    let ball = photometry(EVEN);
    // 100 cd by a multiplier of 2 and a ballast factor of 0.5.
    assert!((ball.flux() - 400.0 * PI).abs() < 1e-9, "{}", ball.flux());
    assert_eq!(ball.name, "Ball");
    for way in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::new(0.6, 0.0, -0.8)] {
        assert!((ball.candela(way) - 100.0).abs() < 1e-9, "{way}");
    }
}

#[test]
fn candela_are_linear_between_angles_and_none_beyond_them() {
    // As made before 1991: no first line of a standard, commas, no uplight.
    let spot = photometry("MAKER\nTILT=NONE\n1,-1,1,3,1,1,1,0,0,0,1,1,50\n0,45,90\n0\n800,200,0");
    let at = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        spot.candela(DVec3::new(sine, -cosine, 0.0))
    };
    for (angle, candela) in [(0.0, 800.0), (22.5, 500.0), (45.0, 200.0), (67.5, 100.0), (90.1, 0.0)]
    {
        assert!((at(angle) - candela).abs() < 1e-6, "{angle}: {}", at(angle));
    }
}

/// A luminaire whose candela at 90° are these at these horizontal angles.
fn around(angles: &str, candela: &[f64]) -> Photometry {
    let rows: String = candela.iter().map(|c| format!("0 {c} 0\n")).collect();
    let count = candela.len();
    photometry(&format!("TILT=NONE\n1 -1 1 3 {count} 1 2 0 0 0 1 1 9\n0 90 180\n{angles}\n{rows}"))
}

#[test]
fn the_rest_of_the_angles_follows_by_symmetry() {
    let candela = |lamp: &Photometry, degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        // Counter-clockwise seen from above: +X, north, -X, south.
        lamp.candela(DVec3::new(cosine, 0.0, -sine))
    };
    let quadrant = around("0 90", &[10.0, 40.0]);
    let half = around("0 90 180", &[10.0, 40.0, 20.0]);
    let other_half = around("90 180 270", &[10.0, 40.0, 20.0]);
    let whole = around("0 90 180 270 360", &[10.0, 40.0, 20.0, 60.0, 10.0]);
    for (degrees, expected) in [
        (0.0, [10.0, 10.0, 40.0, 10.0]),
        (45.0, [25.0, 25.0, 25.0, 25.0]),
        (90.0, [40.0, 40.0, 10.0, 40.0]),
        (135.0, [25.0, 30.0, 25.0, 30.0]),
        (180.0, [10.0, 20.0, 40.0, 20.0]),
        (270.0, [40.0, 40.0, 20.0, 60.0]),
        (315.0, [25.0, 25.0, 30.0, 35.0]),
    ] {
        let found = [&quadrant, &half, &other_half, &whole].map(|lamp| candela(lamp, degrees));
        let close =
            found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6);
        assert!(close, "{degrees}: {found:?} {expected:?}");
    }
}

/// Flux by rectangles of the sphere, lm.
fn by_quadrature(lamp: &Photometry) -> f64 {
    let (rows, columns) = (400, 400);
    let mut sum = 0.0;
    for i in 0..rows {
        let y = -1.0 + 2.0 * (f64::from(i) + 0.5) / f64::from(rows);
        for j in 0..columns {
            let (sin, cos) = (2.0 * PI * (f64::from(j) + 0.5) / f64::from(columns)).sin_cos();
            let flat = (1.0_f64 - y * y).sqrt();
            sum += lamp.candela(DVec3::new(flat * cos, y, flat * sin));
        }
    }
    sum * 4.0 * PI / f64::from(rows * columns)
}

#[test]
fn flux_is_the_integral_of_the_candela() {
    for lamp in [
        around("0 90", &[10.0, 40.0]),
        around("90 180 270", &[10.0, 40.0, 20.0]),
        around("0 30 360", &[10.0, 40.0, 10.0]),
    ] {
        let expected = by_quadrature(&lamp);
        assert!((lamp.flux() / expected - 1.0).abs() < 1e-3, "{} {expected}", lamp.flux());
    }
}

#[test]
fn what_sends_out_more_than_its_lamps_is_noted() {
    assert!(added(EVEN).expect("it is right").notes[0].contains("only 2000 lm"));
    let bright = EVEN.replace("1 2000 2", "1 3000 2");
    assert!(added(&bright).expect("it is right").notes.is_empty());
}

/// The flux of [`EVEN`] with something else in it, lm, and what is noted beside its surplus.
fn as_found(from: &str, to: &str) -> (f64, Vec<String>) {
    let text = EVEN.replace(from, to);
    assert!(from.is_empty() || text != EVEN, "{from}");
    let mut notes = added(&text).expect("it can be read").notes;
    notes.retain(|note| !note.contains("sends out"));
    (photometry(&text).flux(), notes)
}

#[test]
fn the_number_after_the_ballast_factor_is_a_factor_in_old_files_only() {
    let flux = |standard: &str, number: &str| {
        let text = EVEN.replace("IESNA:LM-63-2002\n", standard).replace("0.5 1 60", number);
        photometry(&text).flux() / (400.0 * PI)
    };
    for code in ["1.00001", "1.10000", "1.11000"] {
        let found = flux("IES:LM-63-2019\n", &format!("0.5 {code} 60"));
        assert!((found - 1.0).abs() < 1e-12, "{code}: {found}");
    }
    for standard in ["IESNA:LM-63-1995\n", "IESNA:LM-63-2002\n"] {
        assert!((flux(standard, "0.5 0.9 60") - 1.0).abs() < 1e-12, "{standard}");
    }
    for standard in ["IESNA91\n", "MAKER\n", ""] {
        assert!((flux(standard, "0.5 0.9 60") - 0.9).abs() < 1e-12, "{standard}");
    }
}

#[test]
fn files_as_they_are_found_are_read() {
    let right = 400.0 * PI;
    for (from, to) in [
        ("\n", "\r"),
        ("\n", "\r\n"),
        ("TILT=NONE\n", "TILT=NONE "),
        ("TILT=NONE", "tilt=None"),
        ("[TEST] x\n", "[TESTLAB] x\n[TESTMETHOD] LM-79-19\n[ABSOLUTE] 1\n"),
        (" ", ","),
        ("100 100 100\n", "100 100 100\n\u{1a}"),
    ] {
        let (flux, notes) = as_found(from, to);
        assert!((flux - right).abs() < 1e-9 && notes.is_empty(), "{to:?}: {flux} {notes:?}");
    }
    for (from, to, word) in [
        ("TILT=NONE\n", "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.95 0.9\n", "TILT=INCLUDE"),
        ("TILT=NONE", "TILT=lamp.tlt", "TILT=lamp.tlt"),
        ("100 100 100\n", "100 100 100\nEND 5\n", "\"END\""),
    ] {
        let (flux, notes) = as_found(from, to);
        assert!((flux - right).abs() < 1e-9, "{to:?}: {flux}");
        assert!(notes.len() == 1 && notes[0].contains(word), "{to:?}: {notes:?}");
    }
}

#[test]
fn what_is_not_supported_is_refused_with_its_line() {
    for (from, to, words) in [
        ("TILT=NONE", "TILT=INCLUDE", ["lamp.ies:9", "ends before tilt angles"]),
        ("TILT=NONE", "", ["lamp.ies:9", "no line with TILT="]),
        ("3 1 1 2 0", "3 1 2 2 0", ["lamp.ies:5", "type B"]),
        ("3 1 1 2 0", "3 1 3 2 0", ["lamp.ies:5", "type A"]),
        ("0 90 180", "0 90 90", ["lamp.ies:7", "does not ascend"]),
        ("180\n0\n", "180\n5\n", ["lamp.ies:8", "from 5 to 5"]),
        ("100 100 100", "100 100", ["lamp.ies:9", "ends before candela"]),
        ("100 100 100", "100 -1 100", ["lamp.ies:9", "out of range"]),
        ("100 100 100", "100 many 100", ["lamp.ies:9", "\"many\""]),
        ("2000 2 3", "2000 2 1e9", ["lamp.ies:5", "vertical angles"]),
        ("0.5 1 60", "nan 1 60", ["lamp.ies:6", "ballast factor"]),
    ] {
        let message = added(&EVEN.replacen(from, to, 1)).expect_err(to);
        assert!(words.iter().all(|word| message.contains(word)), "{to}: {message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_file_is_too_strange(at in 0..EVEN.len(), text in "[-0-9. ,eE\nnaN=]{0,12}", cut in 0_usize..9) {
        let end = EVEN.len().min(at + cut);
        let strange = format!("{}{text}{}", &EVEN[..at], &EVEN[end..]);
        if let Ok(mut scene) = added(&strange)
            && let Light::Luminaire { photometry, .. } = scene.lights.remove(0).light
        {
            let candela = photometry.candela(DVec3::new(0.48, -0.6, 0.64));
            prop_assert!(candela.is_finite() && candela >= 0.0 && photometry.flux().is_finite());
        }
    }
}
