//! What names an occluder.

use crate::ids::id;

id! {
    /// Names one of the [`Occluders`](super::Occluders) of one scene.
    OccluderId
}
