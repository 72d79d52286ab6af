//! Error against the number of triangles, and how many make the error small.

/// A mesh: how many triangles it has, and how far it is from the truth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) triangles: usize,
    /// Over all places, and over the shadow set; shares of the mean.
    pub(crate) errors: [f64; 2],
}

/// How many triangles make an error small.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Needed {
    /// As many, between two measured meshes.
    Triangles(f64),
    /// As many, if the last measured trend goes on.
    Extrapolated(f64),
    /// The last trend does not lead there, or not with a bearable number.
    NotReached,
}

/// Trends are not followed beyond so many times the largest number of triangles measured.
const FARTHEST: f64 = 10.0;

/// Triangles for an error in the shadow set, by straight lines between logarithms; samples come
/// from coarse to fine.
pub(crate) fn needed(samples: &[Sample], error: f64) -> Needed {
    let logs: Vec<[f64; 2]> =
        samples.iter().map(|s| [(s.triangles as f64).ln(), s.errors[1].ln()]).collect();
    let goal = error.ln();
    let through = |pair: &[[f64; 2]]| {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        (x0 + (goal - y0) / (y1 - y0) * (x1 - x0)).exp()
    };
    if let Some(pair) = logs.windows(2).find(|pair| pair[0][1] > goal && pair[1][1] <= goal) {
        return Needed::Triangles(through(pair));
    }
    let all_below = logs[0][1] <= goal;
    let end = if all_below { &logs[..2] } else { &logs[logs.len() - 2..] };
    let (count, last) = (through(end), logs[logs.len() - 1][0].exp());
    if end[1][1] < end[0][1] && end[1][0] > end[0][0] && count <= FARTHEST * last {
        return Needed::Extrapolated(count);
    }
    Needed::NotReached
}

/// How many times as many triangles the first needs as the second.
pub(crate) fn ratio(one: Needed, other: Needed) -> String {
    match (one, other) {
        (Needed::NotReached, _) | (_, Needed::NotReached) => "-".to_owned(),
        (Needed::Triangles(a), Needed::Triangles(b)) => format!("{:.2}", a / b),
        (
            Needed::Triangles(a) | Needed::Extrapolated(a),
            Needed::Triangles(b) | Needed::Extrapolated(b),
        ) => format!("~{:.2}", a / b),
    }
}

impl std::fmt::Display for Needed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(&match self {
            Self::Triangles(count) => format!("{count:.0}"),
            Self::Extrapolated(count) => format!("~{count:.0}"),
            Self::NotReached => "not reached".to_owned(),
        })
    }
}
