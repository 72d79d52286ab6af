//! The ways to find form factors.

/// How form factors are found.
///
/// Where nothing stands between two patches, all methods use the exact formula; they differ in how
/// they find what is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormFactorMethod {
    /// Exactly: what occluders hide is cut away, and the rest integrated.
    Contour,
    /// By hemicubes with this many cells, an even number, along an edge: from a point; over a patch, by
    /// four of half as many, or more where views differ.
    Hemicube(u32),
    /// By spheres of this many rays.
    Rays(u32),
}
