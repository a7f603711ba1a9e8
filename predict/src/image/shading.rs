//! The light that a point of the part sends to the camera (equation 1 of the paper).

use crate::image_arcs::lit_scene::{StageError, StageLight};
use crate::image_arcs::pierce::front;
use crate::image_arcs::{LitScene, RegionSample};
use crate::prepared_part::PreparedPart;
use crate::reflectance::{GREEN, Polarisation, SurfaceFinish};
use crate::setup::light::{IncidentLight, LightSource};
use crate::setup::{Conditions, SetupError};
use nalgebra::{Point2, Point3, Vector3};
use premio_kernel::brep::topology::FaceId;
use premio_visibility::ray_casting::FirstHit;
use std::f64::consts::PI;

/// A point of a face on a line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ViewedPoint {
    /// The point.
    pub point: Point3<f64>,
    /// The unit direction of the line of sight, into the scene.
    pub direction: Vector3<f64>,
}

/// The materials of a part's faces.
#[derive(Clone, Debug)]
pub struct Finishes {
    /// By face: an index into [`Conditions::materials`].
    by_face: Vec<usize>,
}

impl Finishes {
    /// The materials of the faces of a part under conditions.
    ///
    /// # Errors
    /// A surface of the conditions names a face that the part does not have.
    pub fn new(subject: &PreparedPart<'_>, conditions: &Conditions) -> Result<Self, StageError> {
        let count = subject.brep.topology.faces.len();
        let mut by_face = vec![0; count];
        for (i, finish) in conditions.surfaces.iter().enumerate() {
            for &face in &finish.faces {
                let place = by_face.get_mut(face as usize);
                let missing = || {
                    let reason = format!("names face {face}, and the part has {count}");
                    SetupError::value(format!("surface[{i}].faces"), reason)
                };
                *place.ok_or_else(missing)? = i + 1;
            }
        }
        Ok(Self { by_face })
    }
}

/// A light with the reflectances of the part under it.
#[derive(Clone, Debug)]
struct Beam {
    polarisation: Polarisation,
    /// By material: its surface at the light's wavelength.
    surfaces: Vec<SurfaceFinish>,
}

impl Beam {
    fn new(source: &LightSource, conditions: &Conditions) -> Result<Self, SetupError> {
        let [parallel, perpendicular] = source.polarisation;
        let negative = || SetupError::value("light.parallel", "or `perpendicular` is negative");
        let materials = conditions.materials(source.wavelength)?;
        Ok(Self {
            polarisation: Polarisation::new(parallel, perpendicular).ok_or_else(negative)?,
            surfaces: materials.iter().map(SurfaceFinish::new).collect(),
        })
    }
}

/// The radiance from a point to the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Radiance {
    /// All of it, I^r.
    pub total: f64,
    /// The specular part of it.
    pub specular: f64,
}

/// The light of a scene, in grey levels of the sensor before noise and steps.
#[derive(Debug)]
pub struct Shading<'s> {
    stage: &'s LitScene<'s>,
    finishes: &'s Finishes,
    unblocked_fraction: &'s [f64],
    ambient: f64,
    background: f64,
    /// Levels for each unit of radiance on the optical axis.
    gain: f64,
    /// By light.
    beams: Vec<Beam>,
    /// By material: the parts of its surface that do not depend on the wavelength.
    surfaces: Vec<SurfaceFinish>,
}

impl<'s> Shading<'s> {
    /// The light of a scene under conditions.
    pub(crate) fn new(
        stage: &'s LitScene<'s>,
        finishes: &'s Finishes,
        conditions: &Conditions,
    ) -> Result<Self, SetupError> {
        let lights = stage.lights.iter().map(|light| &light.source);
        let strength: f64 = lights.clone().map(|source| source.strength()).sum();
        // Without lights the surroundings shine on a white surface from everywhere.
        let strength = if strength > 0.0 {
            strength
        } else {
            conditions.ambient * PI
        };
        let beams: Result<_, _> = lights.map(|s| Beam::new(s, conditions)).collect();
        let materials = conditions.materials(GREEN)?;
        Ok(Self {
            stage,
            finishes,
            unblocked_fraction: &stage.subject.unblocked_fraction,
            ambient: conditions.ambient,
            background: conditions.background,
            gain: conditions.sensor.gain(strength),
            beams: beams?,
            surfaces: materials.iter().map(SurfaceFinish::new).collect(),
        })
    }

    /// The radiance of a point of a face towards `viewer`, a unit vector, where the lights of `lit`
    /// reach it.
    pub(crate) fn radiance(
        &self,
        face: FaceId,
        p: &Point3<f64>,
        viewer: &Vector3<f64>,
        lit: u64,
    ) -> Radiance {
        let material = self.finishes.by_face[face.index()];
        let normal = self.stage.subject.brep.outward(face, p);
        let around = self.ambient
            * self.surfaces[material].ambient()
            * self.unblocked_fraction[face.index()];
        let mut all = Radiance {
            total: around,
            specular: 0.0,
        };
        for (i, (StageLight { source, .. }, beam)) in
            self.stage.lights.iter().zip(&self.beams).enumerate()
        {
            if lit >> i & 1 == 0 {
                continue;
            }
            let IncidentLight {
                direction: towards,
                strength,
            } = source.from(p);
            let cosine = normal.dot(&towards);
            if cosine > 0.0 {
                let surface = &beam.surfaces[material];
                let r = surface.reflectance(&normal, &towards, viewer, beam.polarisation);
                all.total += strength * cosine * r.total;
                all.specular += strength * cosine * r.specular;
            }
        }
        all
    }

    /// The point of a face that is visible at a point of the image, with the viewing direction.
    /// `hint` is its approximate distance, and becomes the exact one.
    pub(crate) fn place(&self, at: [f64; 2], face: FaceId, hint: &mut f64) -> Option<ViewedPoint> {
        let projection = self.stage.view.scene.projection;
        let sight = projection.line_of_sight(&Point2::from(at));
        let far = front(self.stage.subject.brep, face, &sight, *hint)?;
        *hint = far;
        Some(ViewedPoint {
            point: sight.origin + sight.direction * far,
            direction: sight.direction,
        })
    }

    /// Grey levels, before noise and steps, at a point of the image where `seen` is seen.
    pub(crate) fn level(&self, at: [f64; 2], seen: &RegionSample, hint: &mut f64) -> f64 {
        self.levels(at, seen, hint).total
    }

    /// The grey levels with their specular part.
    pub(crate) fn levels(&self, at: [f64; 2], seen: &RegionSample, hint: &mut f64) -> Radiance {
        let placed = seen
            .face
            .and_then(|face| Some((face, self.place(at, face, hint)?)));
        let (radiance, into) = match placed {
            Some((face, seen_at)) => {
                let into = seen_at.direction;
                (self.radiance(face, &seen_at.point, &-into, seen.lit), into)
            }
            None => {
                let projection = self.stage.view.scene.projection;
                let into = projection.line_of_sight(&Point2::from(at)).direction;
                let background = Radiance {
                    total: self.background,
                    specular: 0.0,
                };
                (background, into)
            }
        };
        let cosine = into.dot(&self.stage.view.scene.projection.axis());
        // C relative to its value on the optical axis, at which the exposure is set.
        let gain = self.gain * (cosine * cosine) * (cosine * cosine);
        Radiance {
            total: gain * radiance.total,
            specular: gain * radiance.specular,
        }
    }

    /// The number of lights.
    pub(crate) fn lights(&self) -> usize {
        self.stage.lights.len()
    }

    /// The surface of a face.
    pub(crate) fn surface(&self, face: FaceId) -> &premio_kernel::geometry::surface::Surface {
        self.stage.subject.brep.surface(face)
    }

    /// Whether a face has specular reflection.
    pub(crate) fn mirrors(&self, face: FaceId) -> bool {
        self.surfaces[self.finishes.by_face[face.index()]].is_specular()
    }

    /// N·H at the point of a face that is visible at a point of the image: 1 at perfect specular
    /// reflection. None where the light is behind the face.
    pub(crate) fn mirrored(
        &self,
        at: [f64; 2],
        face: FaceId,
        light: usize,
        hint: &mut f64,
    ) -> Option<f64> {
        let ViewedPoint {
            point: p,
            direction: into,
        } = self.place(at, face, hint)?;
        let normal = self.stage.subject.brep.outward(face, &p);
        let towards = self.stage.lights[light].source.from(&p).direction;
        let between = towards - into;
        (normal.dot(&towards) > 0.0).then(|| normal.dot(&between) / between.norm())
    }

    /// The distance of a point from the start of its line of sight.
    pub(crate) fn distance(&self, p: &Point3<f64>) -> f64 {
        (p - self.stage.view.scene.projection.origin()).norm()
    }

    /// The face on the line of sight through a point of the image, and the lights that reach it
    /// there.
    pub fn cast(&self, at: [f64; 2]) -> RegionSample {
        let Some(FirstHit { face, point }) = self.stage.seen(at) else {
            return RegionSample {
                face: None,
                point: self.stage.subject.centre,
                lit: 0,
            };
        };
        let normal = self.stage.subject.brep.outward(face, &point);
        let reaches = |i: &usize| {
            let towards = self.stage.lights[*i].source.from(&point).direction;
            normal.dot(&towards) > 0.0 && self.stage.is_lit(*i, &point, face)
        };
        let lit = (0..self.stage.lights.len()).filter(reaches);
        RegionSample {
            face: Some(face),
            point,
            lit: lit.fold(0, |all, i| all | 1 << i),
        }
    }
}
