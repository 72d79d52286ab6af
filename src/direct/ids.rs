//! What names an emitter.

use crate::ids::id;

id! {
    /// Names one of the [`Emitters`](super::Emitters) of one scene.
    EmitterId
}
