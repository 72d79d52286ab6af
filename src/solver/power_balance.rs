//! Where the emitted power has gone.

use serde::{Deserialize, Serialize};

use crate::colour::Rgb;

/// Powers, W per channel; what was emitted is what was absorbed, escaped or is still unshot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PowerBalance {
    /// Sent out by emitters; of light from infinitely far, what arrives in the scene.
    pub emitted: Rgb,
    /// Absorbed by the fronts of surfaces.
    pub absorbed: Rgb,
    /// Absorbed by the black backs of surfaces.
    pub on_backs: Rgb,
    /// Gone where there is no surface.
    pub escaped: Rgb,
    /// Received and not yet sent on.
    pub unshot: Rgb,
}

impl PowerBalance {
    /// What is missing from the balance, as a share of the emitted power; negative if there is too much.
    pub fn imbalance(&self) -> f64 {
        let accounted = self.absorbed + self.on_backs + self.escaped + self.unshot;
        let emitted = self.emitted.element_sum();
        if emitted > 0.0 { (self.emitted - accounted).element_sum() / emitted } else { 0.0 }
    }

    /// Share of the emitted power that is still unshot.
    pub fn unshot_share(&self) -> f64 {
        let emitted = self.emitted.element_sum();
        if emitted > 0.0 { self.unshot.element_sum() / emitted } else { 0.0 }
    }
}
