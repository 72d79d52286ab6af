//! Reflected light: exchanged between patches, then brought to the vertices.

use super::context::Context;
use super::gather::Gatherer;
use super::interpolate::{REFLECTED, interpolate};
use super::lit_mesh::LitMesh;
use super::observer::Observer;
use super::power_balance::PowerBalance;
use super::progressive::Shooting;
use super::relaxation::RelaxationStep;
use super::solution::Solution;
use super::sources::Sources;
use super::spread::spread;
use super::stop::Stop;
use super::work::Work;
use super::{direct_pass, indirect_pass};
use crate::colour::Rgb;
use crate::error::Result;
use crate::light::{ElementLight, Optics, VertexLight};
use crate::mesh::{Mesh, VertexId};
use crate::refine::Oracle;
use crate::settings::Settings;

/// How often light is gathered: from what the exchange left on the elements, then from what the first
/// gathering found at their vertices. A third changed no result.
const ROUNDS: usize = 2;

/// Reflected light, exchanged between the patches of a mesh as it is.
pub(super) struct Interreflection {
    light: ElementLight,
    energy: PowerBalance,
    pub(super) stop: Stop,
    shots: usize,
    /// Hemicubes looked through: over patches, and over vertices.
    hemicubes: [usize; 2],
    work: Work,
    ambient: Rgb,
    history: Vec<RelaxationStep>,
}

impl Interreflection {
    pub(super) fn new(
        context: Context<'_>,
        settings: &Settings,
        mesh: &Mesh,
        vertices: &VertexLight,
        observer: &mut Observer<'_>,
    ) -> Result<Self> {
        let mut shooting = Shooting::new(context, settings, mesh, vertices, observer);
        let (stop, history) = shooting.run(settings)?;
        let mut light = std::mem::take(&mut shooting.light);
        light.settle(mesh, &shooting.received);
        let ambient = if stop == Stop::Converged {
            light.scale_to_the_rest(mesh, shooting.ambient());
            Rgb::ZERO
        } else {
            shooting.ambient_of_the_rest()
        };
        let Shooting { energy, shots, hemicubes, factors, .. } = shooting;
        let work = Work::new(context.light.lamps(), factors);
        Ok(Self { light, energy, stop, shots, hemicubes: [hemicubes, 0], work, ambient, history })
    }

    /// Brings the light to the vertices: gathered, if all has been exchanged.
    pub(super) fn reach_vertices(
        &mut self,
        context: Context<'_>,
        settings: &Settings,
        lit: &mut LitMesh<'_>,
        observer: &mut Observer<'_>,
    ) {
        if self.stop == Stop::Converged {
            self.gather(context, settings, lit, observer);
        } else {
            self.spread(lit.mesh, lit.light);
        }
        let Work { exchange, gathering, .. } = self.work;
        self.work = Work { gathering, ..Work::new(context.light.lamps(), exchange) };
    }

    /// Gathers the light at vertices, and refines the mesh to it.
    fn gather(
        &mut self,
        context: Context<'_>,
        settings: &Settings,
        lit: &mut LitMesh<'_>,
        observer: &mut Observer<'_>,
    ) {
        let optics = context.optics;
        let sources = self.sources(lit.mesh, optics, lit.light);
        let level = sources.level(lit.mesh, lit.light);
        let oracle = Oracle::of_reflected_light(settings, context.surfaces.extent, level);
        let mut gatherer = Gatherer::new(context.to_gather(), settings, lit.mesh, sources, level);
        for round in 1..=ROUNDS {
            indirect_pass::refine(settings, &oracle, &mut gatherer, lit, observer);
            direct_pass::light_leaves(context, lit, observer);
            if observer.flow.is_break() {
                break;
            }
            if round < ROUNDS {
                interpolate(lit.mesh, lit.light, REFLECTED);
                gatherer.replace_sources(lit, Sources::of_vertices(lit.mesh, optics, lit.light));
            }
        }
        if observer.flow.is_break() {
            self.stop = Stop::Cancelled;
            self.give_corners(lit.mesh, lit.light);
        }
        interpolate(lit.mesh, lit.light, REFLECTED);
        self.hemicubes[1] = gatherer.gathered;
        self.work.gathering = gatherer.factors;
    }

    /// The solution that this comes to, with this light at the vertices of the mesh.
    pub(super) fn solution(
        self,
        mesh: Mesh,
        optics: Optics,
        vertex_light: VertexLight,
    ) -> Solution {
        let Self { light, energy, stop, shots, hemicubes, work, ambient, history } = self;
        Solution {
            mesh,
            optics,
            vertex_light,
            light,
            energy,
            stop,
            shots,
            hemicubes,
            work,
            ambient,
            history,
        }
    }

    /// What a gathering vertex sees.
    fn sources<'a>(&self, mesh: &Mesh, optics: &'a Optics, vertices: &VertexLight) -> Sources<'a> {
        let mut irradiance = self.light.indirect_at_vertices(mesh);
        for (index, sum) in irradiance.iter_mut().enumerate() {
            *sum += vertices.direct_irradiance(VertexId(index as u32));
        }
        Sources::new(mesh, optics, &self.light, irradiance)
    }

    /// Gives corners of patches that lack reflected light what the patch has of it.
    fn give_corners(&self, mesh: &Mesh, vertices: &mut VertexLight) {
        for patch in &mesh.patches {
            for &corner in &mesh[patch.root].corners {
                if vertices.indirect(corner).is_none() {
                    vertices.set_indirect(corner, self.light.indirect[patch.root.index()]);
                }
            }
        }
    }

    /// Brings what the elements hold to the vertices, and the ambient light.
    pub(super) fn spread(&self, mesh: &Mesh, vertices: &mut VertexLight) {
        spread(&self.light, self.ambient, mesh, vertices);
    }
}
