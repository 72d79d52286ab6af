//! The verdict on curves whose laws are known.

use proptest::prelude::*;
use radiosity::compare::{
    Band, BandVerdict, Contest, Cost, CostCurve, Family, Needed, Winner, nearest_law,
};

/// Runs whose error is `factor` N^slope.
fn law(factor: f64, slope: f64, counts: &[f64]) -> CostCurve {
    CostCurve::new(counts.iter().map(|&n| (n, factor * n.powf(slope))))
}

const COUNTS: [f64; 4] = [100.0, 400.0, 1600.0, 6400.0];

fn verdict(uniform: CostCurve, adaptive: CostCurve, error: Option<f64>) -> BandVerdict {
    let contests = [Cost::Elements, Cost::Seconds].map(|cost| Contest {
        cost,
        curves: [uniform.clone(), adaptive.clone()],
        floor: 1e-6,
    });
    BandVerdict::new(Band::All, &contests, error).expect("both have runs")
}

#[test]
fn known_slopes_give_known_ratios() {
    let found = verdict(law(1.0, -0.25, &COUNTS), law(1.0, -1.0, &COUNTS), None);
    let [uniform, adaptive] = found.slopes.fitted.map(Option::unwrap);
    assert!((uniform + 0.25).abs() < 1e-12 && (adaptive + 1.0).abs() < 1e-12);
    assert_eq!(nearest_law(uniform).1, "a jump");
    assert_eq!(nearest_law(adaptive).1, "smooth light");

    // At 10 %: uniform 10⁴ elements, which it has not; at the most it reaches, 6400^-¼, adaptive is long there.
    let at = found.at_equal_error[0];
    assert!((at.error - 6400.0_f64.powf(-0.25)).abs() < 1e-12);
    assert_eq!(at.winner(), Winner::One(Family::Adaptive));
    assert_eq!(at.needed[1], Needed::AtMost(100.0_f64.ln().exp()));
    assert!((at.ratio().unwrap() - 64.0).abs() < 1e-6);

    let at = found.at_equal_cost[0];
    assert!((at.amount - 6400.0).abs() < 1e-6);
    assert!((at.errors[0] / at.errors[1] - 6400.0_f64.powf(0.75)).abs() < 1e-6);
    assert!(found.sentences()[0].starts_with("Adaptive wins"), "{:?}", found.sentences());
}

#[test]
fn an_error_beyond_all_runs_is_not_reached() {
    let found = verdict(law(1.0, -0.25, &COUNTS), law(1.0, -1.0, &COUNTS), Some(0.001));
    let at = found.at_equal_error[0];
    assert_eq!(at.needed[0], Needed::NotReached);
    assert!(matches!(at.needed[1], Needed::About(n) if (n - 1000.0).abs() < 1e-6));
    assert_eq!((at.ratio(), at.winner()), (None, Winner::One(Family::Adaptive)));
    assert!(found.sentences()[0].contains("uniform does not reach it"), "{:?}", found.sentences());

    let nobody = verdict(law(1.0, -0.25, &COUNTS), law(1.0, -1.0, &COUNTS), Some(1e-5));
    assert_eq!(nobody.at_equal_error[0].winner(), Winner::Unknown);
}

#[test]
fn uniform_may_win_and_near_misses_are_ties() {
    let worse = verdict(law(1.0, -1.0, &COUNTS), law(1.5, -1.0, &COUNTS), None);
    assert!(worse.sentences()[0].starts_with("Adaptive lost: for"), "{:?}", worse.sentences());
    assert!(worse.sentences()[1].contains("(adaptive lost)"), "{:?}", worse.sentences());
    let alike = verdict(law(1.0, -1.0, &COUNTS), law(1.08, -1.0, &COUNTS), None);
    assert!(alike.sentences()[0].starts_with("A tie"), "{:?}", alike.sentences());
    assert!(alike.sentences()[1].contains("(a tie)"), "{:?}", alike.sentences());
}

#[test]
fn who_fared_how_in_what_is_told_apart() {
    let told = |elements: [f64; 2], seconds: [f64; 2]| {
        let curve = |factor: f64| law(factor, -1.0, &COUNTS);
        let contest =
            |cost, factors: [f64; 2]| Contest { cost, curves: factors.map(curve), floor: 1e-6 };
        let contests = [contest(Cost::Elements, elements), contest(Cost::Seconds, seconds)];
        let found = BandVerdict::new(Band::All, &contests, Some(1e-3)).expect("both have runs");
        found.sentences()[0].split(": ").next().expect("a lead").to_owned()
    };
    assert_eq!(told([1.0, 0.5], [1.0, 0.5]), "Adaptive wins");
    assert_eq!(told([1.0, 2.0], [1.0, 0.5]), "Adaptive lost in elements and won in time");
    assert_eq!(told([1.0, 1.0], [1.0, 2.0]), "Adaptive tied in elements and lost in time");
    assert_eq!(told([1.0, 2.0], [1.0, 2.0]), "Adaptive lost");
}

#[test]
fn errors_below_the_floor_are_unresolved() {
    let curve = || law(1.0, -1.0, &COUNTS);
    let contest = |cost| Contest { cost, curves: [curve(), curve()], floor: 0.5 };
    let found =
        BandVerdict::new(Band::All, &[contest(Cost::Elements), contest(Cost::Seconds)], None);
    let [first, second] = found.expect("both have runs").sentences();
    assert!(
        first.contains("does not resolve") && second.contains("unresolved"),
        "{first} {second}"
    );
}

proptest! {
    #[test]
    fn cost_and_error_are_inverse(slope in -1.5..-0.1_f64, factor in 0.01..10.0_f64, share in 0.0..1.0_f64) {
        let curve = law(factor, slope, &COUNTS);
        let cost = 100.0 * 64.0_f64.powf(share);
        let error = curve.error_at(cost).unwrap();
        prop_assert!((error / (factor * cost.powf(slope)) - 1.0).abs() < 1e-9);
        let back = curve.cost_for(error).amount().unwrap();
        prop_assert!((back / cost - 1.0).abs() < 1e-6, "{back} for {cost}");
        prop_assert!((curve.slope().unwrap() - slope).abs() < 1e-9);
    }

    #[test]
    fn any_numbers_have_a_verdict(pairs in prop::collection::vec((-1.0..1e6_f64, -1.0..2.0_f64), 0..8)) {
        let (one, other) = pairs.split_at(pairs.len() / 2);
        let curves = [one, other].map(|pairs| CostCurve::new(pairs.iter().copied()));
        let contests = [Cost::Elements, Cost::Seconds]
            .map(|cost| Contest { cost, curves: curves.clone(), floor: 0.001 });
        if let Some(found) = BandVerdict::new(Band::All, &contests, None) {
            for sentence in found.sentences() {
                prop_assert!(!sentence.contains("NaN") && sentence.ends_with('.'), "{sentence}");
            }
        }
    }
}
