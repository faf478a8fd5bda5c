//! Contact of the moving tile with the fixed one and with the table's rim, by rapier.

use nalgebra::Vector3;
use rapier2d_f64::dynamics::{
    CoefficientCombineRule, MassProperties, RigidBodyBuilder, RigidBodyHandle, SpringCoefficients,
};
use rapier2d_f64::geometry::{ColliderBuilder, SharedShape};
use rapier2d_f64::math::{Pose, Vector};
use rapier2d_f64::pipeline::PhysicsWorld;

use super::body::{Body, Phase};
use crate::tile::Outline;

/// Half the width (m) of the bars that the rim is made of.
const BAR: f64 = 0.5;

/// What happens where surfaces touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface {
    pub restitution: f64,
    pub friction: f64,
}

/// rapier's view of the table: the fixed tile, the rim and the moving tile.
pub(super) struct Collision {
    world: PhysicsWorld,
    moving: RigidBodyHandle,
    centre: Vector,
}

impl Collision {
    /// `rim` holds half the table's size (m) along x and y where there is one. Contacts are seen
    /// within `range` (m).
    pub fn new(
        outlines: (&Outline, &Outline),
        body: &Body,
        rim: Option<[f64; 2]>,
        surface: Surface,
        range: f64,
    ) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        let parameters = &mut world.integration_parameters;
        // One solver pass a step, so that force and motion alternate as in the leapfrog method;
        // several sweeps of it, since friction and the two ends of a face depend on each other.
        parameters.num_solver_iterations = 1;
        parameters.num_internal_pgs_iterations = 8;
        parameters.contact_recycling = false;
        parameters.contact_clustering = false;
        parameters.normalized_prediction_distance = 2.0 * range;
        parameters.normalized_allowed_linear_error = 1e-6;
        // Contact gives way like a spring: by a / (2 pi f)^2 under an acceleration a, here 0.05 um
        // under the 180 m/s^2 of the paper's bond.
        let stiff = SpringCoefficients {
            natural_frequency: 1e4,
            damping_ratio: 5.0,
        };
        parameters.contact_softness = stiff;
        parameters.static_contact_softness = stiff;

        let collider = |shape: SharedShape| {
            ColliderBuilder::new(shape)
                .density(0.0)
                .restitution(surface.restitution)
                .restitution_combine_rule(CoefficientCombineRule::Min)
                .friction(surface.friction)
                .friction_combine_rule(CoefficientCombineRule::Min)
        };
        world.insert(RigidBodyBuilder::fixed(), collider(shape(outlines.0)));
        if let Some([x, y]) = rim {
            // Thick bars, not half planes: those would be near every part of the tile everywhere.
            let (length, width) = (x.max(y) + 2.0 * BAR, BAR);
            for (half, at) in [
                ([width, length], Vector::new(x + width, 0.0)),
                ([width, length], Vector::new(-x - width, 0.0)),
                ([length, width], Vector::new(0.0, y + width)),
                ([length, width], Vector::new(0.0, -y - width)),
            ] {
                let bar = collider(SharedShape::cuboid(half[0], half[1])).translation(at);
                world.insert(RigidBodyBuilder::fixed(), bar);
            }
        }
        let centre = Vector::new(body.centre.x, body.centre.y);
        let moving = RigidBodyBuilder::dynamic()
            .additional_mass_properties(MassProperties::new(centre, body.mass, body.inertia))
            .can_sleep(false);
        let (moving, _) = world.insert(moving, collider(shape(outlines.1)));
        Self {
            world,
            moving,
            centre,
        }
    }

    /// Puts the moving tile somewhere else.
    pub fn place(&mut self, phase: &Phase) {
        let pose = Pose::new(Vector::ZERO, phase.place.z);
        let lever = pose.rotation * self.centre;
        let at = Vector::new(phase.place.x, phase.place.y) - lever;
        self.world.bodies[self.moving].set_position(Pose::new(at, phase.place.z), true);
        self.set_velocity(&phase.velocity);
    }

    pub fn set_velocity(&mut self, velocity: &Vector3<f64>) {
        let body = &mut self.world.bodies[self.moving];
        body.set_linvel(Vector::new(velocity.x, velocity.y), true);
        body.set_angvel(velocity.z, true);
    }

    /// One step of `h` (s) under a steady acceleration of the centre of mass: first the velocity,
    /// so that it neither enters contact nor breaks friction's law, then the place.
    pub fn step(&mut self, acceleration: &Vector3<f64>, h: f64) -> Phase {
        self.world.integration_parameters.dt = h;
        let body = &mut self.world.bodies[self.moving];
        let velocity = body.linvel() + Vector::new(acceleration.x, acceleration.y) * h;
        let spin = body.angvel() + acceleration.z * h;
        body.set_linvel(velocity, true);
        body.set_angvel(spin, true);
        self.world.step();
        self.phase()
    }

    fn phase(&self) -> Phase {
        let body = &self.world.bodies[self.moving];
        let (centre, velocity) = (body.center_of_mass(), body.linvel());
        Phase {
            place: Vector3::new(centre.x, centre.y, body.rotation().angle()),
            velocity: Vector3::new(velocity.x, velocity.y, body.angvel()),
        }
    }
}

fn shape(outline: &Outline) -> SharedShape {
    let mut parts: Vec<_> = outline
        .parts()
        .iter()
        .filter_map(|part| {
            let points = part.points.iter().map(|p| Vector::new(p.x, p.y)).collect();
            SharedShape::convex_polyline_unmodified(points)
        })
        .map(|shape| (Pose::IDENTITY, shape))
        .collect();
    if parts.len() == 1 {
        parts.remove(0).1
    } else {
        SharedShape::compound(parts)
    }
}
