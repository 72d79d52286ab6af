//! Cells of an adaptive integration, which share the points on their borders.

use glam::DVec3;

use super::cubature::at;
use super::unoccluded::exchange;
use super::view::{PairView, VisibleOfAll, add, share};
use crate::geometry::PlanarPolygon;

/// A part of a quadrilateral, seen from three by three points: its corners, the middles of its edges
/// and its centre.
pub(super) struct CubatureCell {
    quadrilateral: [DVec3; 4],
    /// From and to, along each side of the unit square.
    bounds: [[f64; 2]; 2],
    /// By step along the first side, then along the second.
    looks: [[VisibleOfAll; 3]; 3],
    /// By Simpson's rule, m².
    pub(super) exchange: VisibleOfAll,
    /// How far the visible exchange may be wrong, m², as the view bends along each side.
    errors: [f64; 2],
}

/// Share of the square of a view's change that counts as a bend.
const STEEP: f64 = 0.25;

/// Share of the bend of what would be seen of all that counts as one of the visible part: shadows
/// have details as fine as it has.
const COARSE: f64 = 0.1;

/// Simpson's weights.
const WEIGHTS: [f64; 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];

impl CubatureCell {
    /// All of a quadrilateral.
    pub(super) fn whole(view: &PairView<'_>, quadrilateral: [DVec3; 4]) -> Self {
        const STEPS: [f64; 3] = [0.0, 0.5, 1.0];
        let looks = STEPS.map(|s| STEPS.map(|t| view.look(&quadrilateral, [s, t])));
        Self::new(quadrilateral, [[0.0, 1.0]; 2], looks)
    }

    fn new(
        quadrilateral: [DVec3; 4],
        bounds: [[f64; 2]; 2],
        looks: [[VisibleOfAll; 3]; 3],
    ) -> Self {
        let area = bounds.iter().map(|[from, to]| to - from).product::<f64>();
        let mut exchange = [0.0; 2];
        for (row, u) in looks.iter().zip(WEIGHTS) {
            for (look, v) in row.iter().zip(WEIGHTS) {
                exchange = add(exchange, look.map(|seen| area * u * v * seen));
            }
        }
        // Were the same share seen from everywhere, there would be no error.
        let (mean, middle) = (share(exchange), exchange[1] / area);
        let line = |line: [VisibleOfAll; 3]| {
            let [first, between, last] = line.map(|[visible, all]| visible - mean * all);
            let all = line.map(|look| look[1]);
            // A shadow's edge in the very middle looks straight.
            let slope = (last - first).powi(2) / middle.max(f64::MIN_POSITIVE);
            let bend = |a: f64, b: f64, c: f64| (a - 2.0 * b + c).abs();
            bend(first, between, last) + STEEP * slope + COARSE * bend(all[0], all[1], all[2])
        };
        // What separates Simpson's rule from that of trapezoids.
        let error = |lines: [[VisibleOfAll; 3]; 3]| {
            let sum: f64 = lines.into_iter().zip(WEIGHTS).map(|(l, weight)| weight * line(l)).sum();
            sum * area / 12.0
        };
        let errors = [error(transposed(looks)), error(looks)];
        Self { quadrilateral, bounds, looks, exchange, errors }
    }

    /// How far the visible exchange may be wrong, m².
    pub(super) fn error(&self) -> f64 {
        self.errors[0] + self.errors[1]
    }

    /// Its halves along the side along which its view bends more.
    pub(super) fn halves(&self, view: &PairView<'_>) -> [Self; 2] {
        let along = usize::from(self.errors[1] > self.errors[0]);
        let [from, to] = self.bounds[along];
        let middle = 0.5 * (from + to);
        let across = self.bounds[1 - along];
        let steps = [across[0], 0.5 * (across[0] + across[1]), across[1]];
        let line = |at: f64| {
            steps.map(|step| {
                let place = if along == 0 { [at, step] } else { [step, at] };
                view.look(&self.quadrilateral, place)
            })
        };
        let lines = if along == 0 { self.looks } else { transposed(self.looks) };
        [(0, from, middle), (1, middle, to)].map(|(k, low, high)| {
            let looks = [lines[k], line(0.5 * (low + high)), lines[k + 1]];
            let mut bounds = self.bounds;
            bounds[along] = [low, high];
            Self::new(
                self.quadrilateral,
                bounds,
                if along == 0 { looks } else { transposed(looks) },
            )
        })
    }

    /// Exchange, m², of it with all of `to`.
    pub(super) fn unhidden(&self, view: &PairView<'_>) -> f64 {
        let [s, t] = self.bounds;
        let places = [[s[0], t[0]], [s[1], t[0]], [s[1], t[1]], [s[0], t[1]]];
        let corners = places.map(|[s, t]| at(&self.quadrilateral, s, t).0);
        exchange(PlanarPolygon { corners: &corners, ..view.from }, view.to)
    }
}

fn transposed(looks: [[VisibleOfAll; 3]; 3]) -> [[VisibleOfAll; 3]; 3] {
    [0, 1, 2].map(|i| [0, 1, 2].map(|k| looks[k][i]))
}
