//! Contact lines: where another surface stands on, touches or pierces a surface.
//!
//! Light jumps across such a line, so no element may lie on both sides of it. What hovers close over a
//! surface counts as touching it: there, light falls nearly as steeply.
//!
//! What is close depends on the two surfaces, and what is too small for a mesh to show is left out: a surface has a
//! few neighbours to look at, however large the scene and however fine its facets. Nothing is kept for a pair of
//! them but its lines.

use rayon::prelude::*;
use smallvec::SmallVec;

use super::model::{Contact, Surface};
use crate::geometry::Plane;
use crate::geometry::boxes::{Aabb, Tree, are_close};
use crate::geometry::polygon::{Line, Ring, Segment, contains, distance, edges};

/// What faces a surface from less than this share of the scene's extent hovers close over it: a wider gap is wide
/// enough for elements of its own, few times as large as the smallest of [`Settings::draft`].
///
/// [`Settings::draft`]: crate::settings::Settings::draft
const CLOSE: f64 = 1e-2;

/// And than this share of the size of either: light falls gently beside what is far off for its size.
const CLOSE_FOR_SIZE: f64 = 0.1;

/// Cosine of the greatest angle at which that faces it: 5°.
const PARALLEL: f64 = 0.996;

/// What is smaller than this share of the scene's extent draws no lines: it is smaller than the smallest element of
/// [`Settings::high`](crate::settings::Settings::high).
const SMALLEST: f64 = 1.0 / 2000.0;

/// Surfaces smaller than so many of the smallest elements cannot be divided, and get no lines.
const DIVISIBLE: f64 = 2.0;

/// Distances, m.
#[derive(Clone, Copy, Debug)]
struct ContactLimits {
    /// This far from a plane is in it.
    epsilon: f64,
    /// This far from a surface may be close to it.
    close: f64,
    /// What is smaller is not shown.
    smallest: f64,
}

/// Finds the contact lines of every surface with every other, in a scene of this extent, m, and stores
/// them in both.
pub(super) fn find_contacts(surfaces: &mut [Surface], extent: f64, epsilon: f64) {
    let near = ContactLimits::new(extent, epsilon);
    let all = &*surfaces;
    let tree = Tree::new(all.par_iter().map(Surface::aabb).collect());
    let lines_of = |found: &mut Vec<u32>, receiver: usize| {
        near.find_neighbours(&tree, &all[receiver].plane, receiver, found);
        let others = found.iter().map(|&other| other as usize).filter(|&other| other != receiver);
        others.flat_map(|other| near.lines(all, tree.boxes(), [receiver, other])).collect()
    };
    let lines: Vec<Vec<Contact>> =
        (0..all.len()).into_par_iter().map_init(Vec::new, lines_of).collect();
    surfaces.iter_mut().zip(lines).for_each(|(surface, lines)| surface.contacts = lines);
}

impl ContactLimits {
    fn new(extent: f64, epsilon: f64) -> Self {
        Self { epsilon, close: CLOSE * extent, smallest: SMALLEST * extent }
    }

    /// How far what hovers close over a surface may be, m; over two of them, the smaller counts.
    fn reach(&self, bounds: Aabb) -> f64 {
        self.close.min(CLOSE_FOR_SIZE * bounds.diagonal()).max(2.0 * self.epsilon)
    }

    /// The surfaces that may have lines on one: those with a part close over it or in its plane.
    fn find_neighbours(&self, tree: &Tree, plane: &Plane, receiver: usize, found: &mut Vec<u32>) {
        found.clear();
        let bounds = tree.boxes()[receiver];
        if bounds.diagonal() < DIVISIBLE * self.smallest {
            return;
        }
        let reach = self.reach(bounds);
        let meets = |other: Aabb| {
            let middle = plane.height(other.middle());
            let around = other.half_extent(plane.normal);
            // Twice the epsilon, so that rounding loses nothing.
            other.diagonal() >= self.smallest
                && are_close(bounds, other, reach)
                && middle - around <= reach + self.epsilon
                && middle + around >= -2.0 * self.epsilon
        };
        tree.find(meets, found);
    }

    /// The lines of the second surface on the first.
    fn lines(
        &self,
        surfaces: &[Surface],
        bounds: &[Aabb],
        [receiver, other]: [usize; 2],
    ) -> Vec<Contact> {
        let close = self.reach(bounds[receiver]).min(self.reach(bounds[other]));
        if !are_close(bounds[receiver], bounds[other], close) {
            return Vec::new();
        }
        contacts(&surfaces[receiver], &surfaces[other], [self.epsilon, close])
    }
}

/// Of the corners of each ring, m.
type Heights = SmallVec<[SmallVec<[f64; 4]>; 1]>;

/// The lines along which `other` meets the front or the plane of `receiver`, inside of it.
fn contacts(receiver: &Surface, other: &Surface, [epsilon, close]: [f64; 2]) -> Vec<Contact> {
    let height = |&p: &_| {
        let height = receiver.plane.height(other.plane.lift(p));
        if height.abs() <= epsilon { 0.0 } else { height }
    };
    let rings = other.rings.iter();
    let heights: Heights = rings.map(|ring| ring.iter().map(height).collect()).collect();
    let all = || heights.iter().flatten().copied();
    let (lowest, highest) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
    let (behind, above) = (highest <= 0.0 && lowest < 0.0, lowest > 0.0);
    let hovers =
        above && highest <= close && other.plane.normal.dot(receiver.plane.normal) < -PARALLEL;
    if behind || (above && !hovers) {
        return Vec::new();
    }
    let lies = |h: f64| h == 0.0 || hovers;
    let mut lines = edges_where(lies, receiver, other, &heights);
    let pierced = piercing_line(receiver, other, &heights).into_iter();
    lines.extend(pierced.map(|segment| Contact { segment, gap: 0.0 }));
    let parts = |Contact { segment, gap }| {
        let parts = inside(&receiver.rings, segment, epsilon).into_iter();
        parts.map(move |segment| Contact { segment, gap })
    };
    lines.into_iter().flat_map(parts).collect()
}

/// Edges of `other`, seen along the receiver's normal, whose ends are at certain heights.
fn edges_where(
    lies: impl Fn(f64) -> bool,
    receiver: &Surface,
    other: &Surface,
    heights: &Heights,
) -> Vec<Contact> {
    let mut lines = Vec::new();
    for (ring, heights) in other.rings.iter().zip(heights) {
        for (k, edge) in edges(ring).enumerate() {
            let ends = [heights[k], heights[(k + 1) % heights.len()]];
            if ends.into_iter().all(&lies) {
                let segment = edge.map(|p| receiver.plane.flatten(other.plane.lift(p)));
                lines.push(Contact { segment, gap: f64::midpoint(ends[0], ends[1]) });
            }
        }
    }
    lines
}

/// The pieces of the line in which `other` crosses the receiver's plane, in pairs of crossings along it.
fn piercing_line(receiver: &Surface, other: &Surface, heights: &Heights) -> Vec<Segment> {
    let mut crossings = Vec::new();
    for (ring, heights) in other.rings.iter().zip(heights) {
        for (k, [a, b]) in edges(ring).enumerate() {
            let (from, to) = (heights[k], heights[(k + 1) % heights.len()]);
            if (from < 0.0) != (to < 0.0) {
                let point = other.plane.lift(a.lerp(b, from / (from - to)));
                crossings.push(receiver.plane.flatten(point));
            }
        }
    }
    let along = receiver.plane.normal.cross(other.plane.normal);
    let along = receiver.plane.flatten(receiver.plane.origin + along);
    crossings.sort_by(|a, b| a.dot(along).total_cmp(&b.dot(along)));
    crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The parts of a segment inside rings and not on its outline.
pub(super) fn inside(rings: &[Ring], segment: Segment, epsilon: f64) -> Vec<Segment> {
    let outline = || rings.iter().flat_map(|ring| edges(ring));
    let mut parts = vec![segment];
    for edge in outline() {
        let line = Line::through(edge);
        for k in (0..parts.len()).rev() {
            if let [Some(left), Some(right)] = line.split_segment(parts[k], epsilon) {
                parts[k] = left;
                parts.insert(k + 1, right);
            }
        }
    }
    let is_inside = |&[a, b]: &Segment| {
        let middle = a.midpoint(b);
        a.distance(b) > epsilon
            && contains(rings, middle)
            && outline().all(|edge| distance(edge, middle) > epsilon)
    };
    parts.retain(is_inside);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Face, Material, Scene};
    use crate::surface::{Surfaces, surfaces_of};
    use glam::DVec3;
    use proptest::prelude::*;

    fn add(scene: &mut Scene, polygon: &[DVec3]) {
        let first = scene.positions.len() as u32;
        let vertices = (first..first + polygon.len() as u32).collect();
        scene.positions.extend(polygon);
        scene.faces.push(Face { vertices, ..Face::default() });
    }

    /// Sides of a box, seen from outside.
    fn add_box(scene: &mut Scene, low: DVec3, size: DVec3) {
        let corner = |k: usize| {
            low + size * DVec3::from([0, 1, 2].map(|axis| f64::from((k >> axis & 1) as u32)))
        };
        for side in
            [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]]
        {
            add(scene, &side.map(corner));
        }
    }

    /// An empty floor of this length and width, m, from the origin.
    fn floor(length: f64, width: f64) -> Scene {
        let mut scene = Scene { materials: vec![Material::default()], ..Scene::default() };
        let (x, z) = (length * DVec3::X, width * DVec3::Z);
        add(&mut scene, &[DVec3::ZERO, z, x + z, x]);
        scene
    }

    /// Triangles of a sphere of unit radius, in rings from pole to pole, so many around.
    fn sphere(around: usize) -> Vec<[DVec3; 3]> {
        let place = |ring: usize, k: usize| {
            let step = std::f64::consts::TAU / around as f64;
            let (height, turn) = (step * ring as f64, step * (k % around) as f64);
            DVec3::new(height.sin() * turn.cos(), height.cos(), height.sin() * turn.sin())
        };
        let quads = (0..around / 2).flat_map(|ring| (0..around).map(move |k| (ring, k)));
        let halves = quads.flat_map(|(ring, k)| {
            let [a, b] = [place(ring, k), place(ring, k + 1)];
            let [c, d] = [place(ring + 1, k + 1), place(ring + 1, k)];
            [[a, b, c], [a, c, d]]
        });
        halves.filter(|[a, b, c]| (b - a).cross(c - a).length() > 1e-9).collect()
    }

    /// Lines of all pairs, large enough, with the same distances.
    fn of_all_pairs(Surfaces { list, extent, epsilon, .. }: &Surfaces) -> Vec<Vec<Contact>> {
        let near = ContactLimits::new(*extent, *epsilon);
        let size = |k: usize| list[k].extent();
        let lines = |receiver: usize, other: usize| {
            let reach = near.reach(list[receiver].aabb()).min(near.reach(list[other].aabb()));
            contacts(&list[receiver], &list[other], [*epsilon, reach])
        };
        let of = |receiver: usize| {
            let others = (0..list.len()).filter(|&k| k != receiver && size(k) >= near.smallest);
            let divisible = size(receiver) >= DIVISIBLE * near.smallest;
            others.filter(|_| divisible).flat_map(|other| lines(receiver, other)).collect()
        };
        (0..list.len()).map(of).collect()
    }

    /// A block of one of four sizes, on a lattice or a hair over it.
    fn block() -> impl Strategy<Value = (DVec3, DVec3)> {
        let size = prop::sample::select(vec![0.004, 0.01, 0.25, 1.0]);
        let lift = prop::sample::select(vec![0.0, 5e-4, 0.015]);
        let place =
            prop::array::uniform3(0..16_u32).prop_map(|p| 0.25 * DVec3::from(p.map(f64::from)));
        (place, lift, prop::array::uniform3(size))
            .prop_map(|(place, lift, size)| (place + lift * DVec3::Y, DVec3::from(size)))
    }

    proptest! {
        #[test]
        fn lines_are_those_of_a_look_at_all_pairs(
            blocks in prop::collection::vec(block(), 1..12),
            leaves in prop::collection::vec(prop::array::uniform9(0.0..4.0_f64), 0..12),
        ) {
            let mut scene = floor(4.0, 4.0);
            blocks.into_iter().for_each(|(low, size)| add_box(&mut scene, low, size));
            for leaf in leaves {
                add(&mut scene, &[0, 3, 6].map(|k| DVec3::from_slice(&leaf[k..])));
            }
            let surfaces = surfaces_of(&scene);
            let found: Vec<_> = surfaces.list.iter().map(|surface| surface.contacts.clone()).collect();
            prop_assert_eq!(found, of_all_pairs(&surfaces));
        }
    }

    #[test]
    fn a_box_that_hovers_low_over_a_table_draws_its_outline_there() {
        let mut scene = floor(6.0, 5.0);
        add_box(&mut scene, DVec3::new(2.0, 0.7, 2.0), DVec3::new(1.2, 0.04, 0.8));
        add_box(&mut scene, DVec3::new(2.4, 0.741, 2.3), DVec3::new(0.3, 0.2, 0.2));
        let surfaces = surfaces_of(&scene);
        let top = surfaces.list.iter().find(|s| s.plane.height(DVec3::Y * 0.74).abs() < 1e-9);
        let lines = &top.expect("the table has a top").contacts;
        assert_eq!(lines.len(), 4, "{lines:?}");
        assert!(
            (lines.iter().map(|line| line.segment[0].distance(line.segment[1])).sum::<f64>() - 1.0)
                .abs()
                < 1e-6
        );
    }

    /// Lines of a table with a book on it and a thin shelf under it, on a floor of this length.
    fn lines_of_furniture(length: f64) -> usize {
        let mut scene = floor(length, 8.0);
        add_box(&mut scene, DVec3::new(2.0, 0.70, 2.0), DVec3::new(1.2, 0.04, 0.7));
        add_box(&mut scene, DVec3::new(2.0, 0.50, 2.0), DVec3::new(1.2, 0.02, 0.7));
        add_box(&mut scene, DVec3::new(2.3, 0.74, 2.2), DVec3::new(0.3, 0.06, 0.2));
        for (x, z) in [(2.0, 2.0), (3.15, 2.0), (2.0, 2.65), (3.15, 2.65)] {
            add_box(&mut scene, DVec3::new(x, 0.0, z), DVec3::new(0.05, 0.7, 0.05));
        }
        surfaces_of(&scene).list.iter().map(|surface| surface.contacts.len()).sum()
    }

    #[test]
    fn furniture_has_no_more_lines_in_a_long_tunnel_than_in_a_room() {
        let [room, tunnel] = [8.0, 480.0].map(lines_of_furniture);
        assert!(tunnel > 0 && tunnel <= room, "{tunnel} lines in the tunnel, {room} in the room");
    }

    #[test]
    fn facets_of_a_thin_walled_ball_draw_no_lines_on_each_other() {
        // The wall, seen from within, is narrow for the room and wide for the facets.
        let mut scene = floor(6.0, 5.0);
        let centre = DVec3::new(3.0, 1.0, 2.5);
        for facet in sphere(120) {
            add(&mut scene, &facet.map(|p| centre + 0.300 * p));
            add(&mut scene, &[2, 1, 0].map(|k| centre + 0.304 * facet[k]));
        }
        let surfaces = surfaces_of(&scene);
        let facets = surfaces.list.iter().filter(|surface| surface.extent() < 1.0);
        assert_eq!(facets.map(|facet| facet.contacts.len()).sum::<usize>(), 0);
    }

    #[test]
    fn lines_are_the_same_at_any_number_of_threads() {
        let mut scene = floor(6.0, 5.0);
        for k in 0..60 {
            let place = DVec3::new(0.08 * f64::from(k), 0.01 * f64::from(k % 3), 2.0);
            add_box(&mut scene, place, DVec3::new(0.3, 0.2, 0.1 + 0.01 * f64::from(k)));
        }
        let [one, two, seven] = [1, 2, 7].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let surfaces = pool.install(|| surfaces_of(&scene));
            surfaces.list.into_iter().map(|surface| surface.contacts).collect::<Vec<_>>()
        });
        assert!(one.iter().any(|lines| !lines.is_empty()));
        assert!(one == two && two == seven);
    }
}
