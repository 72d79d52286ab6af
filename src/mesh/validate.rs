//! A mesh can check itself.

use super::ids::ElementId;
use super::topology::Mesh;

impl Mesh {
    /// Checks that children cover their parents and trees hang together.
    ///
    /// # Panics
    /// When they do not, naming the element.
    pub fn validate(&self) {
        for index in 0..self.elements.len() {
            let element = &self.elements[index];
            assert!(element.area > 0.0, "element {index} has an area of {} m²", element.area);
            if element.is_leaf() {
                continue;
            }
            let covered: f64 = element.children.iter().map(|&child| self[child].area).sum();
            let gap = (covered - element.area).abs();
            assert!(gap <= 1e-6 * element.area, "element {index} lost {gap} m²");
            for &ElementId(child) in &element.children {
                let child = &self.elements[child as usize];
                assert_eq!(
                    child.patch, element.patch,
                    "element {index} has a child on another patch"
                );
                assert_eq!(child.level, element.level + 1, "element {index} has a child too deep");
            }
        }
    }
}
