//! Light straight from emitters at one point.

use std::ops::Add;

use serde::{Deserialize, Serialize};

use crate::colour::Rgb;

/// Light straight from emitters that arrives at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Direct {
    /// Irradiance, W/m².
    pub irradiance: Rgb,
    /// What the irradiance would be if nothing stood between, W/m².
    pub unoccluded: Rgb,
}

impl Direct {
    /// Share of the unoccluded irradiance that arrives, 0..=1; 1 where none could.
    pub fn visible(&self) -> f64 {
        let all = self.unoccluded.element_sum();
        if all > 0.0 { self.irradiance.element_sum() / all } else { 1.0 }
    }
}

impl Add for Direct {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            irradiance: self.irradiance + other.irradiance,
            unoccluded: self.unoccluded + other.unoccluded,
        }
    }
}
