//! Numbers of walls beside the forces on them: where they are, how they move, torques, pressures.

use crate::contact::Partner;
use crate::dem::Dem;
use granular_core::walls::WallMotion;
use granular_core::{Dim, FieldSink, Linear, Shown, ShownAs, Spin, Vector};

/// A number of one wall.
struct Named {
    name: String,
    unit: &'static str,
    meaning: &'static str,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Position(usize),
    Displacement(usize),
    Velocity(usize),
    Angle,
    /// About x, y or z.
    Torque(usize),
    Area,
    Pressure,
}

const ABOUT: [&str; 3] = ["x", "y", "z"];

const TORQUE: &str =
    "torque on the wall about its axis where it turns, else about its middle (the point given for a plane)";
const POSITION: &str = "place of the middle of the wall, or of the point given for a plane";
const DISPLACEMENT: &str = "displacement of this point since the start";
const VELOCITY: &str = "velocity of this point";
const ANGLE: &str = "angle by which the wall has turned";
const AREA: &str = "area on which the pressure of the servo acts; in the plane a length";
const PRESSURE: &str = "force of the grains against the servo over its area";

impl<D: Dim> Dem<D> {
    /// Point \[m\] about which torques on a wall are taken, as it stands now: of its axis where it turns, else that by which its place is
    /// told.
    fn pivot(&self, wall: usize) -> D::Vec {
        match self.walls[wall].motion {
            Some(WallMotion::Turning { about, .. }) => about,
            _ => self.wall_reference(wall),
        }
    }

    /// Where the [reference point](crate::Shape::reference) of a wall is now \[m\].
    ///
    /// # Panics
    /// When there is no wall of this index.
    pub fn wall_reference(&self, wall: usize) -> D::Vec {
        let given = self.walls[wall].shape.reference();
        self.moving_walls.poses.get(wall).map_or(given, |pose| pose.out_of_wall_at(given))
    }

    /// Velocity \[m/s\] of the [reference point](crate::Shape::reference) of a wall.
    ///
    /// # Panics
    /// When there is no wall of this index.
    pub fn wall_velocity(&self, wall: usize) -> D::Vec {
        let at = self.wall_reference(wall);
        self.moving_walls.poses.get(wall).map_or(D::Vec::ZERO, |pose| pose.velocities(at).0)
    }

    /// Torque of the grains on each wall \[N m; N in the plane\]: about its axis where it turns, else about its
    /// [reference point](crate::Shape::reference), where that is now.
    pub fn wall_torques(&self) -> Vec<D::Spin> {
        let pivots: Vec<D::Vec> = (0..self.walls.len()).map(|wall| self.pivot(wall)).collect();
        let mut torques = vec![D::Spin::ZERO; self.walls.len()];
        self.visit_contacts(&mut |contact| {
            if let Partner::Wall(wall) = contact.partner {
                let radius = self.grains.radius[contact.first];
                let touched =
                    self.grains.position[contact.first] - contact.normal * (radius - contact.overlap);
                torques[wall] -= D::cross(touched - pivots[wall], contact.force) + contact.torque;
            }
        });
        torques
    }

    fn wall_named(&self) -> impl Iterator<Item = (usize, Named)> + '_ {
        let moving: Vec<usize> = self.moving_walls.walls().collect();
        self.walls.iter().enumerate().flat_map(move |(wall, description)| {
            let of = &description.name;
            let mut list = Vec::new();
            let mut add = |name: String, unit, meaning, kind| {
                list.push((wall, Named { name, unit, meaning, kind }));
            };
            match D::N {
                2 => add(format!("torque_on_{of}"), "N m", TORQUE, Kind::Torque(2)),
                _ => (0..3).for_each(|axis| {
                    add(format!("torque_on_{of}_{}", ABOUT[axis]), "N m", TORQUE, Kind::Torque(axis));
                }),
            }
            if !moving.contains(&wall) {
                return list;
            }
            for (axis, name) in D::AXES.iter().enumerate() {
                add(format!("position_of_{of}_{name}"), "m", POSITION, Kind::Position(axis));
                add(format!("displacement_of_{of}_{name}"), "m", DISPLACEMENT, Kind::Displacement(axis));
                add(format!("velocity_of_{of}_{name}"), "m/s", VELOCITY, Kind::Velocity(axis));
            }
            if matches!(description.motion, Some(WallMotion::Turning { .. })) {
                add(format!("angle_of_{of}"), "rad", ANGLE, Kind::Angle);
            }
            if self.moving_walls.pressed_area(wall).is_some() {
                let unit = if D::N == 2 { "m" } else { "m^2" };
                add(format!("area_of_{of}"), unit, AREA, Kind::Area);
                add(format!("pressure_on_{of}"), "Pa", PRESSURE, Kind::Pressure);
            }
            list
        })
    }

    pub(crate) fn wall_catalogue(&self) -> impl Iterator<Item = Shown> + '_ {
        let shown = |Named { name, unit, meaning, .. }| Shown::new(name, unit, meaning, ShownAs::Number);
        self.wall_named().map(move |(_, named)| shown(named))
    }

    pub(crate) fn show_wall_numbers(&self, sink: &mut dyn FieldSink) {
        let (mut forces, mut torques) = (None, None);
        for (wall, Named { name, unit, kind, .. }) in self.wall_named() {
            if !sink.wants(&name) {
                continue;
            }
            let value = match kind {
                Kind::Position(axis) => self.wall_reference(wall).component(axis),
                Kind::Displacement(axis) => {
                    (self.wall_reference(wall) - self.walls[wall].shape.reference()).component(axis)
                }
                Kind::Velocity(axis) => self.wall_velocity(wall).component(axis),
                Kind::Angle => self.moving_walls.angle(wall, self.clock.time()).unwrap_or(f64::NAN),
                Kind::Torque(axis) => {
                    torques.get_or_insert_with(|| self.wall_torques())[wall].components()[axis]
                }
                Kind::Area => self.moving_walls.pressed_area(wall).unwrap_or(f64::NAN),
                Kind::Pressure => {
                    let force = forces.get_or_insert_with(|| self.wall_forces())[wall];
                    let area = self.moving_walls.pressed_area(wall).unwrap_or(f64::NAN);
                    match self.walls[wall].motion {
                        Some(WallMotion::Servo(servo)) => -force.dot(servo.direction) / area,
                        _ => f64::NAN,
                    }
                }
            };
            sink.number(&name, unit, value);
        }
    }
}
