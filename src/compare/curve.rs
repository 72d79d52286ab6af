//! Error against cost, by straight lines between logarithms.

use serde::Serialize;

/// Error against cost, from the lowest cost to the highest; all are above zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CostCurve {
    /// Logarithms of cost and error.
    logs: Vec<[f64; 2]>,
}

/// What an error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Needed {
    /// So much, between two runs.
    About(f64),
    /// No more than this, which the cheapest run cost.
    AtMost(f64),
    /// No run came so far.
    NotReached,
}

impl Needed {
    /// The amount, if there is one.
    pub fn amount(self) -> Option<f64> {
        match self {
            Self::About(amount) | Self::AtMost(amount) => Some(amount),
            Self::NotReached => None,
        }
    }
}

impl CostCurve {
    /// Of pairs of cost and error in any order; those that are not above zero are left out.
    pub fn new(pairs: impl IntoIterator<Item = (f64, f64)>) -> Self {
        let sound = |x: f64| x > 0.0 && x.is_finite();
        let pairs = pairs.into_iter().filter(|&(cost, error)| sound(cost) && sound(error));
        let mut logs: Vec<[f64; 2]> = pairs.map(|(cost, error)| [cost.ln(), error.ln()]).collect();
        logs.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
        Self { logs }
    }

    /// The smallest error.
    pub fn least_error(&self) -> Option<f64> {
        self.logs.iter().map(|log| log[1].exp()).min_by(f64::total_cmp)
    }

    /// The lowest and the highest cost.
    pub fn costs(&self) -> Option<[f64; 2]> {
        Some([self.logs.first()?[0].exp(), self.logs.last()?[0].exp()])
    }

    /// The lowest cost at which the error is this small.
    pub fn cost_for(&self, error: f64) -> Needed {
        // The very error of a run is reached by it, whatever logarithms round.
        let goal = error.ln() + 1e-12;
        let Some(first) = self.logs.first() else { return Needed::NotReached };
        if first[1] <= goal {
            return Needed::AtMost(first[0].exp());
        }
        let crossing = self.logs.windows(2).find(|pair| pair[1][1] <= goal);
        crossing.map_or(Needed::NotReached, |pair| {
            let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
            let share = ((y0 - goal) / (y0 - y1)).clamp(0.0, 1.0);
            Needed::About((x0 + (x1 - x0) * share).exp())
        })
    }

    /// The error at a cost between those of the first and the last run.
    pub fn error_at(&self, cost: f64) -> Option<f64> {
        let at = cost.ln();
        let [first, last] = [self.logs.first()?, self.logs.last()?];
        if at < first[0] - 1e-12 || at > last[0] + 1e-12 {
            return None;
        }
        let pair = self.logs.windows(2).find(|pair| at <= pair[1][0]);
        Some(
            pair.map_or(last[1], |pair| {
                let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
                if x1 > x0 { y0 + (y1 - y0) * ((at - x0) / (x1 - x0)).clamp(0.0, 1.0) } else { y1 }
            })
            .exp(),
        )
    }

    /// Slope of the straight line through the logarithms with the least squares of errors: error ~ cost^slope.
    /// `None` if there are no two costs.
    pub fn slope(&self) -> Option<f64> {
        let count = self.logs.len() as f64;
        let mean = |axis: usize| self.logs.iter().map(|log| log[axis]).sum::<f64>() / count;
        let (x, y) = (mean(0), mean(1));
        let products = |axis: usize, middle: f64| {
            self.logs.iter().map(|log| (log[0] - x) * (log[axis] - middle)).sum::<f64>()
        };
        let spread = products(0, x);
        (spread > 1e-12).then(|| products(1, y) / spread)
    }
}
