//! Rows that carry all the light of a shot: no more and no less.

use crate::colour::Rgb;
use crate::solver::links::{Link, Row};

/// Where the links of a row and the hemicube that it was made with disagree by more than this factor, either may be
/// wrong.
const DOUBT: f64 = 1.25;

/// What the parts of a row carry, so that they carry the power of a shot together.
///
/// Elements of a shooter near others see more or less of them than the whole does, and a hemicube knows what little
/// meets surfaces, or misses them, only as exactly as its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Carried {
    /// Factor on what its links carry of what their sources release.
    pub(super) scale: Rgb,
    /// What links carry besides, as if their sources released it, W/m².
    pub(super) even: Rgb,
    /// Factor on what escapes or meets backs.
    pub(super) outside: Rgb,
}

impl Carried {
    /// All of `power`, W, of a shot by a row whose elements have released some, W/m².
    ///
    /// Only what no link carries and nothing outside takes is left out, and missing in the power balance.
    pub(super) fn all(power: Rgb, row: &Row, released: &[Rgb]) -> Self {
        let carry = |link: &Link| released[link.source.index()] * link.exchange_area;
        let linked: Rgb = row.links.iter().map(carry).sum();
        let exchange_area: f64 = row.links.iter().map(|link| link.exchange_area).sum();
        let share = row.escaped + row.on_backs;
        let arriving = power * (1.0 - row.escaped - row.on_backs);
        let channel = |k: usize| {
            Channel { linked: linked[k], exchange_area, outside: power[k] * share }
                .balanced(arriving[k])
        };
        let [red, green, blue] = [0, 1, 2].map(channel);
        let part = |k: usize| Rgb::new(red[k], green[k], blue[k]);
        Self { scale: part(0), even: part(1), outside: part(2) }
    }
}

/// A row in one channel, W.
struct Channel {
    linked: f64,
    /// Of all links, m².
    exchange_area: f64,
    outside: f64,
}

impl Channel {
    /// What makes of it the power that is to be `arriving`, and that goes outside, together: the factor on what is
    /// linked, what links carry besides, and the factor on what goes outside.
    ///
    /// Links follow the hemicube within the doubt; beyond it what goes outside follows the links as far, and only where
    /// there is not enough of that, links carry all the rest. That is no factor: what elements release may be of both
    /// signs in over-relaxation, and come to next to nothing.
    fn balanced(&self, arriving: f64) -> [f64; 3] {
        let Self { linked, exchange_area, outside } = *self;
        let within = |factor: f64| factor.clamp(1.0 / DOUBT, DOUBT);
        let wanted = arriving / linked;
        let scale = if linked == 0.0 { 1.0 } else { within(wanted) };
        let rest = arriving - scale * linked;
        if scale == wanted || rest == 0.0 {
            return [scale, 0.0, 1.0];
        }
        let wanted = if outside == 0.0 { 1.0 } else { 1.0 + rest / outside };
        let factor = if exchange_area == 0.0 { wanted } else { within(wanted) };
        let rest = rest - outside * (factor - 1.0);
        let even = if exchange_area == 0.0 || factor == wanted && outside != 0.0 {
            0.0
        } else {
            rest / exchange_area
        };
        [scale, even, factor]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(row: &Channel, [scale, even, outside]: [f64; 3]) -> f64 {
        scale * row.linked + even * row.exchange_area + outside * row.outside
    }

    #[test]
    fn all_power_is_carried_whoever_is_wrong() {
        for linked in [-0.1, 0.0, 1e-9, 0.02, 0.3, 0.7, 1.1, 3.0] {
            for outside in [0.0, 1e-9, 0.01, 0.5, 0.999, 1.0] {
                let row = Channel { linked, exchange_area: 0.4, outside };
                let parts = row.balanced(1.0 - outside);
                assert!((total(&row, parts) - 1.0).abs() < 1e-12, "{linked}, {outside}: {parts:?}");
                let bounds = 1.0 / DOUBT..=DOUBT;
                assert!(bounds.contains(&parts[0]) && bounds.contains(&parts[2]), "{parts:?}");
            }
        }
    }

    #[test]
    fn where_little_arrives_links_know_it_better() {
        let [scale, even, outside] =
            Channel { linked: 0.002, exchange_area: 0.4, outside: 0.999 }.balanced(0.001);
        assert_eq!([scale, even], [0.8, 0.0]);
        assert!((outside - 0.9984 / 0.999).abs() < 1e-12, "{outside}");
    }

    #[test]
    fn in_a_closed_room_links_carry_all() {
        let [scale, even, outside] =
            Channel { linked: 0.5, exchange_area: 0.25, outside: 0.0 }.balanced(1.0);
        assert_eq!([scale, even, outside], [1.25, 1.5, 1.0]);
    }

    #[test]
    fn what_no_link_carries_goes_outside_if_there_is_an_outside() {
        let parts =
            |outside| Channel { linked: 0.0, exchange_area: 0.0, outside }.balanced(1.0 - outside);
        assert_eq!(parts(0.75), [1.0, 0.0, 1.0 + 0.25 / 0.75]);
        assert_eq!(parts(0.0), [1.0, 0.0, 1.0]);
    }
}
