//! Relaxations of M B = E: all reach what LU factors say, and each in its own way.

mod scene;
mod shelf;

use proptest::prelude::*;
use radiosity::colour::Rgb;
use radiosity::form_factor::FormFactors;
use radiosity::settings::Method;
use radiosity::solver::Stop;
use radiosity::solver::relaxation::{Criteria, Relaxation, Relaxed, System};

const METHODS: [Method; 4] =
    [Method::Jacobi, Method::GaussSeidel, Method::Southwell, Method::Progressive];

/// Ends only when the residual is gone for good.
const EXACT: Criteria = Criteria { residual: 1e-12, change: 0.0, max_shots: 1_000_000 };

/// Patches of random areas that exchange light reciprocally; nothing is lost if `closed`.
#[derive(Clone, Debug)]
struct Room {
    areas: Vec<f64>,
    /// Row by row.
    factors: Vec<f64>,
    reflectance: Vec<Rgb>,
    exitance: Vec<Rgb>,
}

impl Room {
    /// From the exchanges F A, m², of which those above the diagonal are used, and how much of each
    /// patch's view is open.
    fn new(exchanges: &[f64], open: &[f64], reflectance: Vec<Rgb>, exitance: Vec<Rgb>) -> Self {
        let n = open.len();
        let exchange = |i: usize, j: usize| match i.cmp(&j) {
            std::cmp::Ordering::Less => exchanges[i * n + j],
            std::cmp::Ordering::Equal => 0.0,
            std::cmp::Ordering::Greater => exchanges[j * n + i],
        };
        let sum = |i: usize| (0..n).map(|j| exchange(i, j)).sum::<f64>();
        let areas: Vec<f64> = (0..n).map(|i| sum(i) / (1.0 - open[i])).collect();
        let factors = (0..n * n).map(|k| exchange(k / n, k % n) / areas[k / n]).collect();
        Self { areas, factors, reflectance, exitance }
    }

    fn len(&self) -> usize {
        self.areas.len()
    }

    fn system(&self) -> System {
        let n = self.len();
        let row = |i: usize| (0..n).map(move |j| (j as u32, self.factors[i * n + j]));
        let factors = FormFactors::from_rows(self.areas.clone(), (0..n).map(row));
        System::new(factors, self.reflectance.clone(), self.exitance.clone()).unwrap()
    }

    /// The same light counted in watts: residuals are powers, and all patches have unit area.
    fn by_power(&self) -> Self {
        let n = self.len();
        let scaled = |k: usize| self.factors[k] * self.areas[k / n] / self.areas[k % n];
        Self {
            areas: vec![1.0; n],
            factors: (0..n * n).map(scaled).collect(),
            reflectance: self.reflectance.clone(),
            exitance: self.exitance.iter().zip(&self.areas).map(|(&e, &area)| e * area).collect(),
        }
    }
}

fn colour(range: std::ops::Range<f64>) -> impl Strategy<Value = Rgb> {
    [range.clone(), range.clone(), range].prop_map(Rgb::from_array)
}

fn rooms(most: usize) -> impl Strategy<Value = Room> {
    (3..=most).prop_flat_map(|n| {
        let exchanges = proptest::collection::vec(0.01..1.0, n * n);
        let open = proptest::collection::vec(0.0..0.5, n);
        let reflectance = proptest::collection::vec(colour(0.0..0.8), n);
        let exitance = proptest::collection::vec(colour(0.0..10.0), n);
        (exchanges, open, reflectance, exitance)
            .prop_map(|(x, open, r, e)| Room::new(&x, &open, r, e))
    })
}

/// Patches that see each other alike, closed, all of the same reflectance; the first one glows.
fn closed_room(n: usize, reflectance: f64) -> Room {
    let mut exitance = vec![Rgb::ZERO; n];
    exitance[0] = Rgb::new(1.0, 2.0, 3.0);
    Room::new(&vec![0.5; n * n], &vec![0.0; n], vec![Rgb::splat(reflectance); n], exitance)
}

fn relax(system: &System, method: Method, omega: f64, criteria: &Criteria) -> Relaxed {
    system.relax(Relaxation::new(method, omega).unwrap(), criteria)
}

/// Largest difference of any patch and channel.
fn distance(one: &[Rgb], other: &[Rgb]) -> f64 {
    one.iter().zip(other).map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn all_methods_reach_the_direct_solution(room in rooms(24)) {
        let system = room.system();
        let truth = system.solve_directly().unwrap();
        for method in METHODS {
            for omega in [0.6, 1.0, 1.1, 1.5] {
                // Jacobi's is only sure to converge below 2 / (1 + largest reflectance).
                if method == Method::Jacobi && omega > 1.1 {
                    continue;
                }
                let relaxed = relax(&system, method, omega, &EXACT);
                prop_assert_eq!(relaxed.stop, Stop::Converged, "{:?} {}", method, omega);
                let error = distance(&relaxed.radiosity, &truth);
                prop_assert!(error < 1e-9, "{method:?} {omega}: {error}");
            }
        }
    }

    #[test]
    fn the_direct_solution_leaves_no_residual(room in rooms(24), grey in any::<bool>()) {
        let mut room = room;
        if grey {
            room.reflectance.iter_mut().for_each(|r| *r = Rgb::splat(r.x));
        }
        let system = room.system();
        let residual = system.residual(&system.solve_directly().unwrap());
        prop_assert!(distance(&residual, &vec![Rgb::ZERO; room.len()]) < 1e-12);
    }

    #[test]
    fn the_residual_kept_is_the_residual_of_the_radiosity(room in rooms(12), shots in 0_usize..60) {
        let system = room.system();
        for method in METHODS {
            let criteria = Criteria { residual: 0.0, change: 0.0, max_shots: shots };
            let relaxed = relax(&system, method, 1.2, &criteria);
            let residual = system.residual(&relaxed.radiosity);
            let largest = residual.iter().map(|r| r.abs().max_element()).fold(0.0, f64::max);
            let last = relaxed.history.last().unwrap();
            prop_assert!((last.residual - largest).abs() < 1e-12, "{method:?}");
            prop_assert_eq!(last.shots, shots);
            prop_assert_eq!(relaxed.history.len(), shots + 1);
        }
    }

    #[test]
    fn unshot_power_never_grows_without_over_relaxation(room in rooms(24)) {
        for method in METHODS {
            let history = relax(&room.system(), method, 1.0, &EXACT).history;
            for pair in history.windows(2) {
                prop_assert!(pair[1].unshot <= pair[0].unshot + 1e-15, "{method:?}: {pair:?}");
            }
        }
    }

    #[test]
    fn progressive_shooting_is_southwell_scaled_by_area(room in rooms(16), powers in any::<u64>()) {
        let mut room = room;
        // Areas that are powers of two, so that scaling by them is exact, and ties stay ties.
        let n = room.len();
        for i in 0..n {
            let area = f64::from(1_u32 << (powers >> (2 * i) & 3));
            for j in 0..n {
                room.factors[i * n + j] *= room.areas[i] / area / 8.0;
            }
            room.areas[i] = area;
        }
        let by_power = room.by_power();
        let largest = |r: &Room| r.factors.chunks(n).map(|row| row.iter().sum()).fold(0.0, f64::max);
        let tame = 1.0 / f64::max(1.0, largest(&room).max(largest(&by_power)));
        let tamed = |room: &Room| Room {
            factors: room.factors.iter().map(|factor| factor * tame).collect(),
            ..room.clone()
        };
        let progressive = relax(&tamed(&room).system(), Method::Progressive, 1.0, &EXACT);
        let criteria = Criteria { max_shots: progressive.history.len() - 1, residual: 0.0, ..EXACT };
        let southwell = relax(&tamed(&by_power).system(), Method::Southwell, 1.0, &criteria);

        let rows = |relaxed: &Relaxed| relaxed.history.iter().map(|s| s.row).collect::<Vec<_>>();
        prop_assert_eq!(rows(&progressive), rows(&southwell));
        prop_assert!(progressive.history.len() > n, "a room of some patches takes some shots");
        for (patch, area) in room.areas.iter().enumerate() {
            let power = progressive.radiosity[patch] * *area;
            prop_assert_eq!(power, southwell.radiosity[patch]);
        }
    }

    #[test]
    fn emitted_power_is_absorbed_escaped_or_unshot(room in rooms(16), shots in 0_usize..100) {
        let system = room.system();
        for method in METHODS {
            let criteria = Criteria { residual: 0.0, change: 0.0, max_shots: shots };
            let radiosity = relax(&system, method, 1.0, &criteria).radiosity;
            let residual = system.residual(&radiosity);
            let mut balance = Rgb::ZERO;
            for i in 0..room.len() {
                let row = || system.factors().row(i);
                let sent = radiosity[i] * room.areas[i];
                let escaped = sent * (1.0 - row().map(|(_, factor)| factor).sum::<f64>());
                let absorbed: Rgb =
                    row().map(|(j, factor)| sent * factor * (Rgb::ONE - room.reflectance[j])).sum();
                let unshot = residual[i] * room.areas[i];
                balance += room.exitance[i] * room.areas[i] - escaped - absorbed - unshot;
            }
            prop_assert!(balance.abs().max_element() < 1e-9, "{method:?}: {balance}");
        }
    }
}

#[test]
fn furnace_glows_at_e_over_one_minus_rho() {
    let mut room = closed_room(9, 0.6);
    room.exitance.fill(Rgb::new(1.0, 2.0, 0.5));
    let system = room.system();
    let expected = vec![Rgb::new(2.5, 5.0, 1.25); 9];
    assert!(distance(&system.solve_directly().unwrap(), &expected) < 1e-12);
    for method in METHODS {
        let radiosity = relax(&system, method, 1.0, &EXACT).radiosity;
        assert!(distance(&radiosity, &expected) < 1e-10, "{method:?}");
    }
}

#[test]
fn patches_that_see_themselves_are_no_exception() {
    let rows = [vec![(0, 0.4), (1, 0.6)], vec![(0, 0.5), (1, 0.3)]];
    let factors = FormFactors::from_rows(vec![1.0, 1.2], rows);
    let reflectance = vec![Rgb::new(0.5, 0.8, 0.1), Rgb::splat(0.7)];
    let system = System::new(factors, reflectance, vec![Rgb::ONE, Rgb::X]).unwrap();
    let truth = system.solve_directly().unwrap();
    for method in METHODS {
        let relaxed = relax(&system, method, 1.0, &EXACT);
        assert!(distance(&relaxed.radiosity, &truth) < 1e-11, "{method:?}");
        assert!(relaxed.history.len() > 5);
    }
}

#[test]
fn one_sweep_is_enough_where_nothing_is_reflected() {
    let room = closed_room(5, 0.0);
    for method in METHODS {
        let relaxed = relax(&room.system(), method, 1.0, &EXACT);
        assert_eq!((relaxed.stop, relaxed.history.len()), (Stop::Converged, 2), "{method:?}");
    }
}

#[test]
fn every_reason_to_stop_occurs() {
    let system = closed_room(8, 0.9).system();
    let none = Criteria { residual: 0.0, change: 0.0, max_shots: 1_000_000 };
    let stop = |method, omega, criteria: Criteria| relax(&system, method, omega, &criteria);
    for method in METHODS {
        let ended = stop(method, 1.0, Criteria { residual: 1e-3, ..none });
        let last = ended.history.last().unwrap();
        assert!(ended.stop == Stop::Converged && last.residual <= 1e-3, "{method:?}: {last:?}");

        let ended = stop(method, 1.0, Criteria { change: 1e-3, ..none });
        let last = ended.history.last().unwrap();
        assert!(ended.stop == Stop::Unchanged && last.change < 1e-3, "{method:?}: {last:?}");

        let ended = stop(method, 1.0, Criteria { max_shots: 11, ..none });
        assert_eq!((ended.stop, ended.history.len()), (Stop::ShotLimit, 12), "{method:?}");
    }
    // The spectrum of F in this room is 1 and -1/7.
    let over = stop(Method::Jacobi, 1.9, none);
    assert_eq!(over.stop, Stop::Diverged);
    assert!(over.radiosity.iter().all(|b| b.is_finite()));
    let never_zero = stop(Method::GaussSeidel, 1.0, none).stop;
    assert!([Stop::Converged, Stop::Diverged].contains(&never_zero), "rounding ends it");
}

#[test]
fn no_patches_have_no_radiosity() {
    let factors = FormFactors::from_rows(Vec::new(), Vec::<Vec<(u32, f64)>>::new());
    let system = System::new(factors, Vec::new(), Vec::new()).unwrap();
    assert!(system.is_empty() && system.solve_directly().unwrap().is_empty());
    for method in METHODS {
        assert_eq!(relax(&system, method, 1.0, &EXACT).stop, Stop::Converged);
    }
}

#[test]
fn what_cannot_converge_is_refused() {
    let refused = |patch: usize, reflectance: f64, exitance: f64, sum: f64| {
        let row = |i: usize| vec![(((i + 1) % 8) as u32, if i == patch { sum } else { 1.0 })];
        let factors = FormFactors::from_rows(vec![1.0; 8], (0..8).map(row));
        let mut reflectances = vec![Rgb::splat(0.5); 8];
        reflectances[patch].y = reflectance;
        let mut exitances = vec![Rgb::ONE; 8];
        exitances[patch].z = exitance;
        System::new(factors, reflectances, exitances).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(refused(7, 0.99, 1.0, 1.0), Ok(()));
    let grows = "reflectance 1.2 of patch 7: light would grow without end; use less than 1";
    assert_eq!(refused(7, 1.2, 1.0, 1.0), Err(grows.to_owned()));
    for (reflectance, exitance, sum, words) in [
        (1.0, 1.0, 0.5, "reflectance 1 of patch 3"),
        (-0.1, 1.0, 1.0, "reflectance -0.1 of patch 3"),
        (f64::NAN, 1.0, 1.0, "reflectance NaN of patch 3"),
        (0.8, 1.0, 1.25, "reflectance 0.8 of patch 3, whose form factors sum to 1.25"),
        (0.5, f64::INFINITY, 1.0, "of patch 3: use numbers"),
        (0.5, 1.0, f64::NAN, "form factors of patch 3"),
    ] {
        let message = refused(3, reflectance, exitance, sum).unwrap_err();
        assert!(message.contains(words), "{message}");
    }
}

#[test]
fn relaxation_factors_are_between_0_and_2() {
    for omega in [0.0, 2.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = Relaxation::new(Method::Southwell, omega).unwrap_err().to_string();
        assert!(refused.starts_with("omega") && refused.contains("less than 2"), "{refused}");
    }
}

#[test]
fn large_systems_are_not_solved_directly() {
    let n = 5001;
    let factors = FormFactors::from_rows(vec![1.0; n], vec![Vec::<(u32, f64)>::new(); n]);
    let system = System::new(factors, vec![Rgb::ZERO; n], vec![Rgb::ONE; n]).unwrap();
    let refused = system.solve_directly().unwrap_err().to_string();
    assert!(refused.contains("5001 patches") && refused.contains("0.2 GB"), "{refused}");
}
