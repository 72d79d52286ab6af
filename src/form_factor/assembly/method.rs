//! The ways to find form factors, and what comes of them.

use crate::form_factor::matrix::FormFactors;

/// How form factors are found.
///
/// Where nothing stands between two patches, all methods but [`Self::HemicubeSum`] use the exact formula; they differ
/// in how they find what is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormFactorMethod {
    /// Exactly: what occluders hide is cut away, and the rest integrated.
    Contour,
    /// By hemicubes with this many cells, an even number, along an edge: from a point; over a patch, by
    /// four of half as many, or more where views differ.
    Hemicube(u32),
    /// As the hemicube was first used ([Cohen and Greenberg 1985]): the centre of a patch stands for all of it, and a
    /// factor is the sum of the delta form factors of the cells, this many along an edge, that see the other patch.
    /// It errs where patches are near for their size, where from elsewhere on the patch other things are hidden, and
    /// by aliasing where what is seen is as narrow as cells. Rows sum to one as the cells do, but reciprocity is not
    /// kept.
    ///
    /// [Cohen and Greenberg 1985]: https://doi.org/10.1145/325334.325171
    HemicubeSum(u32),
    /// By spheres of this many rays.
    Rays(u32),
}

/// The form factors of a scene.
#[derive(Clone, Debug)]
pub struct Assembled {
    /// The matrix.
    pub factors: FormFactors,
    /// Share of each patch's light that meets the black backs of others.
    pub on_backs: Vec<f64>,
    /// Rows that were finished; the others are empty.
    pub rows: usize,
}
