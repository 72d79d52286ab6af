//! What a solution starts from: emitters on patches, and surfaces that reflect less than all of the light.

use super::observer::Observer;
use super::relaxation;
use super::solution::Phase;
use crate::direct::{DirectLight, Emitters};
use crate::error::{Error, Result};
use crate::light::Optics;
use crate::mesh::Mesh;
use crate::refine::tolerated_direct;
use crate::settings::Settings;
use crate::surface::Surfaces;
use crate::visibility::Occluders;

/// What is said of a scene without light.
pub(super) const DARK: &str = "nothing in the scene emits light; give a material an emission \
                    (Ke in an MTL file, emissiveFactor in glTF) or add a light";

/// Light of points is evaluated on discs with so many of the shortest sides of elements as their radius: what these can
/// follow.
const BLUR: f64 = 4.0;

/// All light straight from emitters on the patches of a mesh; there must be some.
pub(super) fn emitters_on(
    surfaces: &Surfaces,
    settings: &Settings,
    mesh: &Mesh,
    observer: &mut Observer<'_>,
) -> Result<DirectLight> {
    // What is left of emitters once there has been enough is told to the end.
    let _ = observer.begin(Phase::Emitters, 0.0..1.0);
    let blur = BLUR * settings.min_element.metres(surfaces.extent);
    let emitters = Emitters::new(surfaces, mesh).seen_by(settings.shadow_rays).blurred(blur);
    if emitters.is_empty() {
        return Err(Error::Scene(DARK.to_owned()));
    }
    let tolerated = tolerated_direct(settings, surfaces.extent, mesh);
    let occluders = Occluders::new(surfaces);
    let observe = |done| observer.tell(Phase::Emitters, done);
    Ok(DirectLight::observed(emitters, occluders, mesh, observe).tolerating(mesh, tolerated))
}

/// Whether light dies away: loading a file sees to it, a scene made in code may not.
pub(super) fn check_reflectances(surfaces: &Surfaces, mesh: &Mesh, optics: &Optics) -> Result<()> {
    mesh.patches.iter().zip(&optics.reflectance).try_for_each(|(patch, &reflectance)| {
        let material = surfaces[patch.surface].material.index();
        let name = format_args!("material \"{}\"", surfaces.materials[material].name);
        relaxation::check_reflectance(reflectance, name)
    })
}
