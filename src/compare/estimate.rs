//! Radiosity at places, with the standard error that the spread of independent rounds shows.

use std::ops::ControlFlow;
use std::time::Duration;

use rayon::prelude::*;

use super::path_tracer::{Found, PathTracer, Site};
use super::sobol::mixed;
use crate::colour::Rgb;
use crate::watch::watched;

/// Independent rounds; their spread tells the error.
pub(super) const ROUNDS: usize = 16;

/// Paths that all rounds are lengthened by at a time, at first and at most.
const PATHS: [u32; 2] = [16, 64];

/// Paths a round beyond which the even sequence ends.
const MOST_PATHS: u32 = 1 << 16;

/// How much to spend on truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Places all over the surfaces, about.
    pub area_points: usize,
    /// Places where shadow falls steeply, at most.
    pub shadow_points: usize,
    /// Good enough: root mean square of the standard errors, as a share of the mean radiosity. `None`: so small that
    /// a comparison resolves the smallest error of its runs; without runs, 0.2 %.
    pub noise: Option<f64>,
    /// After this, no path begins but the first few.
    pub budget: Duration,
    /// Which random numbers.
    pub seed: u64,
}

impl Default for Effort {
    fn default() -> Self {
        let budget = Duration::from_secs(60);
        Self { area_points: 6000, shadow_points: 3000, noise: None, budget, seed: 1 }
    }
}

/// What is known of one place.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// Which of all places it is: its random numbers hang on that.
    number: u64,
    direct: Rgb,
    reflectance: Rgb,
    rounds: [Rgb; ROUNDS],
    escaped: u32,
}

/// Places whose light becomes known better and better.
#[derive(Debug)]
pub(super) struct LightEstimate<'a> {
    tracer: &'a PathTracer<'a>,
    pub(super) sites: Vec<Site>,
    sums: Vec<Sums>,
    seed: u64,
    /// Paths of each round so far.
    pub(super) paths: u32,
}

impl<'a> LightEstimate<'a> {
    pub(super) fn new(tracer: &'a PathTracer<'a>, sites: Vec<Site>, seed: u64) -> Self {
        let start = |(number, site): (usize, &Site)| Sums {
            number: number as u64,
            direct: tracer.direct(site).irradiance,
            reflectance: tracer.reflectance(site),
            rounds: [Rgb::ZERO; ROUNDS],
            escaped: 0,
        };
        let sums = sites.par_iter().enumerate().map(start).collect();
        Self { tracer, sites, sums, seed, paths: 0 }
    }

    /// The first few paths of each round; none, if `observe` breaks off before all are done.
    pub(super) fn begin(
        &mut self,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        self.lengthen(PATHS[0], || observe(0.0))
    }

    /// Lengthens the rounds until `share_done`, asked each time which part of all paths has been followed, says 1,
    /// or `observe`, told of it, breaks off.
    pub(super) fn run(
        &mut self,
        share_done: &mut dyn FnMut(&Self) -> f64,
        observe: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) {
        loop {
            let done = share_done(self).min(1.0);
            if observe(done).is_break() || done >= 1.0 || self.paths >= MOST_PATHS {
                return;
            }
            let all = f64::from(self.paths) / done.max(f64::MIN_POSITIVE);
            let missing = all.min(f64::from(MOST_PATHS)) as u32 - self.paths;
            let most = self.paths.clamp(PATHS[0], PATHS[1]);
            let more = missing.next_multiple_of(PATHS[0]).clamp(PATHS[0], most);
            if self.lengthen(more, || observe(done)).is_break() {
                return;
            }
        }
    }

    /// As many paths more in each round; none, if `go_on` breaks off before all are done.
    pub(super) fn lengthen(
        &mut self,
        paths: u32,
        go_on: impl FnMut() -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let (tracer, seed) = (self.tracer, self.seed);
        let range = self.paths..self.paths + paths;
        let longer = |(sums, site): (&Sums, &Site)| {
            let mut sums = *sums;
            for (round, sum) in sums.rounds.iter_mut().enumerate() {
                let seed = mixed(&[seed, round as u64, sums.number]);
                let Found { indirect, escaped } = tracer.indirect(site, range.clone(), seed);
                *sum += indirect;
                sums.escaped += escaped;
            }
            sums
        };
        let all = self.sums.par_iter().zip(&self.sites);
        let lengthened: Option<Vec<Sums>> = watched(
            |enough| all.map(|site| (!enough.is_said()).then(|| longer(site))).collect(),
            go_on,
        );
        let Some(sums) = lengthened else { return ControlFlow::Break(()) };
        (self.sums, self.paths) = (sums, self.paths + paths);
        ControlFlow::Continue(())
    }

    /// Radiosity by reflection at a place, and its standard error, W/m².
    pub(super) fn radiosity(&self, number: usize) -> [Rgb; 2] {
        let (sums, count) = (&self.sums[number], ROUNDS as f64);
        let means = sums.rounds.map(|sum| sum / f64::from(self.paths));
        let mean = means.iter().sum::<Rgb>() / count;
        let squares: Rgb = means.iter().map(|&round| (round - mean) * (round - mean)).sum();
        let error = (squares / (count * (count - 1.0))).to_array().map(f64::sqrt);
        // Chance may bring a dark place below zero.
        let arriving = (sums.direct + mean).max(Rgb::ZERO);
        [sums.reflectance * arriving, sums.reflectance * Rgb::from(error)]
    }

    /// That of the scene, m.
    pub(super) fn extent(&self) -> f64 {
        self.tracer.surfaces.extent
    }

    /// Leaves out the places inside something closed and without light, and what `of_places` has of them.
    pub(super) fn leave_out_dark<T>(&mut self, of_places: &mut Vec<T>) {
        let is_dark = |k: usize| self.radiosity(k)[0] == Rgb::ZERO && self.sums[k].escaped == 0;
        let dark: Vec<bool> = (0..self.sums.len()).map(is_dark).collect();
        retain(of_places, &dark);
        retain(&mut self.sites, &dark);
        retain(&mut self.sums, &dark);
    }

    /// Root mean square of the standard errors over the mean radiosity.
    pub(super) fn noise(&self) -> f64 {
        let found = (0..self.sums.len()).map(|number| self.radiosity(number));
        let (light, square) = found.fold((0.0, 0.0), |(light, square), [radiosity, error]| {
            (light + radiosity.element_sum(), square + error.length_squared())
        });
        let count = 3.0 * self.sums.len().max(1) as f64;
        if light > 0.0 { (square / count).sqrt() / (light / count) } else { 0.0 }
    }
}

/// Keeps those of a list that are not `left_out`.
fn retain<T>(list: &mut Vec<T>, left_out: &[bool]) {
    let mut left_out = left_out.iter();
    list.retain(|_| left_out.next() == Some(&false));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::sample_points::area_sites;
    use crate::scene::load;
    use crate::surface::{SurfaceId, Surfaces, surfaces_of};

    fn shipped(name: &str) -> Surfaces {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
        surfaces_of(&load(&path, &Default::default()).unwrap())
    }

    #[test]
    fn in_a_furnace_all_is_alike() {
        let surfaces = shipped("furnace.obj");
        let tracer = PathTracer::new(&surfaces);
        let wall = |surface: SurfaceId, place: glam::DVec2| {
            let plane = surfaces[surface].plane;
            Site { surface, place: plane.lift(place), normal: plane.normal }
        };
        let inside = |surface: SurfaceId| {
            let ring = &surfaces[surface].rings[0];
            let middle = crate::geometry::polygon::centroid(ring);
            [0.0, 0.5, 0.97].map(|share| wall(surface, middle.lerp(ring[0], share)))
        };
        let sites: Vec<Site> = surfaces.ids().flat_map(inside).collect();
        let mut estimate = LightEstimate::new(&tracer, sites.clone(), 1);
        let _ = estimate.lengthen(64, || ControlFlow::Continue(()));
        for number in 0..sites.len() {
            // B = E / (1 - ρ) = 2, of which 1 is emitted.
            let [radiosity, error] = estimate.radiosity(number);
            assert!((radiosity.x - 1.0).abs() <= 5.0 * error.x + 1e-6, "{radiosity} ± {error}");
            assert!(error.x < 0.02, "{error}");
        }
    }

    #[test]
    fn two_seeds_differ_as_their_errors_say() {
        let surfaces = shipped("cornell-box.obj");
        let tracer = PathTracer::new(&surfaces);
        let sites: Vec<Site> =
            area_sites(&surfaces, 300, 1).into_iter().map(|placed| placed.site).collect();
        let found = [1, 2].map(|seed| {
            let mut estimate = LightEstimate::new(&tracer, sites.clone(), seed);
            let _ = estimate.lengthen(32, || ControlFlow::Continue(()));
            estimate
        });
        let (mut squares, mut expected) = (0.0, 0.0);
        for number in 0..sites.len() {
            let [[one, e], [other, f]] = found.each_ref().map(|found| found.radiosity(number));
            squares += (one - other).length_squared();
            expected += e.length_squared() + f.length_squared();
        }
        let ratio = squares / expected;
        assert!((0.85..1.18).contains(&ratio), "{ratio}");
    }
}
