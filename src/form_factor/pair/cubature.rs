//! Gauss's product rules over convex polygons.

use glam::DVec3;

/// Nodes and weights of a rule on 0..1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule(&'static [[f64; 2]]);

const TWO: Rule = Rule(&[[0.211_324_865_405_187_1, 0.5], [0.788_675_134_594_812_9, 0.5]]);

const THREE: Rule = Rule(&[
    [0.112_701_665_379_258_3, 5.0 / 18.0],
    [0.5, 8.0 / 18.0],
    [0.887_298_334_620_741_7, 5.0 / 18.0],
]);

const FOUR: Rule = Rule(&[
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
]);

impl Rule {
    /// The cheapest rule with a relative error below 1e-6 for form factors to what is `ratio` radii
    /// away; none if it is too near.
    pub(super) fn for_ratio(ratio: f64) -> Option<Self> {
        match ratio {
            ratio if ratio > 24.0 => Some(TWO),
            ratio if ratio > 6.0 => Some(THREE),
            ratio if ratio > 3.0 => Some(FOUR),
            _ => None,
        }
    }

    /// ∫ `value` over a convex polygon, m² times its unit.
    pub(super) fn integrate(self, polygon: &[DVec3], value: impl Fn(DVec3) -> f64) -> f64 {
        quadrilaterals(polygon).map(|cell| self.over(&cell, &value)).sum()
    }

    fn over(self, cell: &[DVec3; 4], value: &impl Fn(DVec3) -> f64) -> f64 {
        let Self(nodes) = self;
        let mut sum = 0.0;
        for [s, weight_s] in nodes {
            for [t, weight_t] in nodes {
                let (place, area) = at(cell, *s, *t);
                sum += weight_s * weight_t * area * value(place);
            }
        }
        sum
    }
}

/// A convex polygon as a fan of quadrilaterals; a triangle is one with two corners in one place.
pub(in crate::form_factor) fn quadrilaterals(polygon: &[DVec3]) -> impl Iterator<Item = [DVec3; 4]> + '_ {
    let last = polygon.len() - 1;
    let corner = move |k: usize| polygon[k.min(last)];
    (1..last).step_by(2).map(move |k| [polygon[0], corner(k), corner(k + 1), corner(k + 2)])
}

/// The place (s, t) of a quadrilateral, and its area per area of the unit square there, m².
pub(in crate::form_factor) fn at([a, b, c, d]: &[DVec3; 4], s: f64, t: f64) -> (DVec3, f64) {
    let (near, far) = (a.lerp(*b, s), d.lerp(*c, s));
    let along_s = (b - a).lerp(c - d, t);
    (near.lerp(far, t), along_s.cross(far - near).length())
}
