//! Rows that carry all the light of a shot: no more and no less.

use crate::colour::Rgb;
use crate::solver::links::{Link, Row};

/// Where the links of a row and the hemicube that it was made with disagree by more than this factor, either may be
/// wrong.
const DOUBT: f64 = 1.25;

/// By what the parts of a row are multiplied, so that they carry the power of a shot together.
///
/// Elements of a shooter near others see more or less of them than the whole does, and a hemicube knows what little
/// meets surfaces, or misses them, only as exactly as its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Carried {
    /// What its links carry.
    pub(super) scale: Rgb,
    /// What escapes or meets backs.
    pub(super) outside: Rgb,
}

impl Carried {
    /// All of `power`, W, of which the row's links carry what its elements have released, W/m².
    ///
    /// Only what no link carries and nothing outside takes is left out, and missing in the power balance.
    pub(super) fn all(power: Rgb, row: &Row, released: &[Rgb]) -> Self {
        let carry = |link: &Link| released[link.source.index()] * link.exchange;
        let linked: Rgb = row.links.iter().map(carry).sum();
        let share = row.escaped + row.on_backs;
        let arriving = power * (1.0 - row.escaped - row.on_backs);
        let channel = |k: usize| balanced(linked[k], arriving[k], power[k] * share);
        let [red, green, blue] = [0, 1, 2].map(channel);
        let part = |k: usize| Rgb::new(red[k], green[k], blue[k]);
        Self { scale: part(0), outside: part(1) }
    }
}

/// Factors of what is `linked` and of what goes `outside`, W, so that they come to the power that is to be `arriving`,
/// and that goes outside, together.
///
/// Links follow the hemicube within the doubt; beyond it what goes outside follows the links as far, and only where
/// there is not enough of that, links are to carry all the rest.
fn balanced(linked: f64, arriving: f64, outside: f64) -> [f64; 2] {
    let within = |factor: f64| factor.clamp(1.0 / DOUBT, DOUBT);
    if linked == 0.0 {
        return [1.0, if outside == 0.0 { 1.0 } else { 1.0 + arriving / outside }];
    }
    let wanted = arriving / linked;
    let scale = within(wanted);
    if scale == wanted || outside == 0.0 {
        return [wanted, 1.0];
    }
    let wanted_outside = 1.0 + (arriving - scale * linked) / outside;
    let outside_scale = within(wanted_outside);
    if outside_scale == wanted_outside {
        return [scale, outside_scale];
    }
    [(arriving + outside * (1.0 - outside_scale)) / linked, outside_scale]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total([linked, outside]: [f64; 2], [scale, outside_scale]: [f64; 2]) -> f64 {
        scale * linked + outside_scale * outside
    }

    #[test]
    fn all_power_is_carried_whoever_is_wrong() {
        for linked in [1e-6, 0.02, 0.3, 0.7, 1.1, 3.0] {
            for outside in [0.0, 1e-9, 0.01, 0.5, 0.999, 1.0] {
                let factors = balanced(linked, 1.0 - outside, outside);
                let carried = total([linked, outside], factors);
                assert!((carried - 1.0).abs() < 1e-12, "{carried} by {factors:?}");
                assert!(factors.iter().all(|&factor| factor >= 0.0), "{factors:?}");
            }
        }
    }

    #[test]
    fn where_little_arrives_links_know_it_better() {
        let [scale, outside] = balanced(0.002, 0.001, 0.999);
        assert_eq!(scale, 0.8);
        assert!((outside - 0.9984 / 0.999).abs() < 1e-12, "{outside}");
    }

    #[test]
    fn in_a_closed_room_links_carry_all() {
        assert_eq!(balanced(0.5, 1.0, 0.0), [2.0, 1.0]);
    }

    #[test]
    fn what_nothing_carries_goes_outside_if_there_is_an_outside() {
        assert_eq!(balanced(0.0, 0.25, 0.75)[1], 1.0 / 0.75);
        assert_eq!(balanced(0.0, 1.0, 0.0), [1.0, 1.0]);
    }
}
