//! What names an emitter.

use crate::ids::id;

id! {
    /// Names one of the [`Lamps`](super::Lamps) of one scene.
    EmitterId
}
