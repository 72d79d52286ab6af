//! The integral of ln r over two edges, of which the double contour integral consists.

use glam::DVec3;

/// Edges whose directions differ by less than this, in radians, are parallel.
const PARALLEL: f64 = 1e-9;

/// Deepest bisection of an edge; beyond it, what is left of a logarithm's singularity is rounding.
const DEEPEST: u32 = 30;

/// Differences below this share of the product of two edges' lengths are rounding.
const ROUNDING: f64 = 1e-14;

/// ∫∫ ln(r / `unit`) dx·dy over x on edge `a` and y on edge `b`, m², but for
/// -∫∫ dx·dy, which cancels around closed contours, to within `tolerance`, m².
///
/// Exact for parallel edges, whether apart, overlapping or on one line; for others one of the two
/// integrals is a closed form and the other is done by adaptive Gauss-Kronrod quadrature.
pub(super) fn log_distance(a: [DVec3; 2], b: [DVec3; 2], unit: f64, tolerance: f64) -> f64 {
    let (along_a, along_b) = (a[1] - a[0], b[1] - b[0]);
    let lengths = along_a.length() * along_b.length();
    let cosine = along_a.dot(along_b) / lengths;
    // Perpendicular edges, or one without length.
    if cosine.is_nan() || cosine.abs() < f64::EPSILON {
        return 0.0;
    }
    if along_a.cross(along_b).length() < PARALLEL * lengths {
        return parallel(a, b, unit);
    }
    let (outer, inner) = if along_a.length() < along_b.length() { (a, b) } else { (b, a) };
    let length = outer[0].distance(outer[1]);
    let value = |s: f64| from_point(outer[0].lerp(outer[1], s), inner, unit) * length;
    let tolerance = (tolerance / cosine.abs()).max(ROUNDING * lengths);
    cosine * integrate(&value, [0.0, 1.0], tolerance, DEEPEST)
}

/// The same for parallel edges: second antiderivatives of ln r along the common direction.
fn parallel(a: [DVec3; 2], b: [DVec3; 2], unit: f64) -> f64 {
    let length = a[0].distance(a[1]);
    let along = (a[1] - a[0]) / length;
    let [from, to] = b.map(|end| (end - a[0]).dot(along));
    let apart = (b[0] - a[0]).cross(along).length();
    let at = |u: f64| {
        let square = u * u + apart * apart;
        if square == 0.0 {
            return 0.0;
        }
        let log = 0.5 * (square / (unit * unit)).ln();
        0.5 * (u * u - apart * apart) * log + apart * u * u.atan2(apart) - 0.25 * u * u
    };
    at(to) - at(to - length) - at(from) + at(from - length)
}

/// ∫ ln(r / `unit`) dy from a point, over an edge, m, but for the edge's length.
fn from_point(point: DVec3, [from, to]: [DVec3; 2], unit: f64) -> f64 {
    let length = from.distance(to);
    let along = (to - from) / length;
    let (start, end) = ((from - point).dot(along), (to - point).dot(along));
    let apart = (from - point).cross(along).length();
    let log = |u: f64| {
        let square = u * u + apart * apart;
        if square > 0.0 { 0.5 * u * (square / (unit * unit)).ln() } else { 0.0 }
    };
    log(end) - log(start) + apart * (apart * length).atan2(apart * apart + start * end)
}

/// Nodes above zero of the 15 point rule of Kronrod on -1..1, outermost first; every second one,
/// and zero, are those of Gauss's 7 point rule.
const NODES: [f64; 7] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
];

/// Weights of the two rules at those nodes, Kronrod's first.
const WEIGHTS: [[f64; 2]; 7] = [
    [0.022_935_322_010_529_225, 0.0],
    [0.063_092_092_629_978_56, 0.129_484_966_168_869_7],
    [0.104_790_010_322_250_18, 0.0],
    [0.140_653_259_715_525_92, 0.279_705_391_489_276_64],
    [0.169_004_726_639_267_9, 0.0],
    [0.190_350_578_064_785_4, 0.381_830_050_505_118_9],
    [0.204_432_940_075_298_9, 0.0],
];

/// Weights of the two rules at zero.
const MIDDLE: [f64; 2] = [0.209_482_141_084_727_82, 0.417_959_183_673_469_4];

/// ∫ `value` between two bounds to within `tolerance`, by bisection where the two rules disagree.
fn integrate(
    value: &impl Fn(f64) -> f64,
    [low, high]: [f64; 2],
    tolerance: f64,
    depth: u32,
) -> f64 {
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let centre = value(middle);
    let mut sums = MIDDLE.map(|weight| weight * centre);
    for (node, weights) in NODES.iter().zip(WEIGHTS) {
        let pair = value(middle - half * node) + value(middle + half * node);
        sums = [sums[0] + weights[0] * pair, sums[1] + weights[1] * pair];
    }
    let [fine, coarse] = sums.map(|sum| sum * half);
    if depth == 0 || (fine - coarse).abs() <= tolerance {
        return fine;
    }
    let part = |bounds| integrate(value, bounds, 0.5 * tolerance, depth - 1);
    part([low, middle]) + part([middle, high])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The integral by brute force, with the part that cancels left in.
    fn by_midpoints(a: [DVec3; 2], b: [DVec3; 2]) -> f64 {
        const CELLS: i32 = 1200;
        let at = |k: i32| (f64::from(k) + 0.5) / f64::from(CELLS);
        let grid = (0..CELLS).flat_map(|i| (0..CELLS).map(move |j| (at(i), at(j))));
        let sum: f64 =
            grid.map(|(s, t)| a[0].lerp(a[1], s).distance(b[0].lerp(b[1], t)).ln()).sum();
        sum * (a[1] - a[0]).dot(b[1] - b[0]) / f64::from(CELLS).powi(2)
    }

    #[test]
    fn rules_are_exact_on_polynomials() {
        let exact = integrate(&|x| x.powi(11) - 3.0 * x * x, [0.0, 2.0], f64::INFINITY, 0);
        assert!((exact - (4096.0 / 12.0 - 8.0)).abs() < 1e-11, "{exact}");
        let exact = integrate(&|x: f64| x.powi(22), [-1.0, 1.0], f64::INFINITY, 0);
        assert!((exact - 2.0 / 23.0).abs() < 1e-14, "{exact}");
    }

    #[test]
    fn integrals_over_edges_are_those_of_brute_force() {
        let a = [DVec3::ZERO, DVec3::X];
        let parallel = [DVec3::new(1.4, 0.3, 0.2), DVec3::new(-0.2, 0.3, 0.2)];
        let oblique = [DVec3::new(0.2, 0.5, 0.3), DVec3::new(0.9, 1.1, -0.4)];
        let touching = [DVec3::ZERO, DVec3::new(0.5, 0.8, 0.0)];
        for b in [parallel, oblique, touching] {
            let dropped = -(a[1] - a[0]).dot(b[1] - b[0]);
            let (exact, brute) = (log_distance(a, b, 1.0, 1e-12), by_midpoints(a, b));
            assert!((exact + dropped - brute).abs() < 1e-5, "{} for {brute}", exact + dropped);
        }
    }
}
