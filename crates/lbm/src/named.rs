//! Obstacles and faces by name: how they move, and how that is changed during a run.

use crate::boundary::Builder;
use crate::lattice::Lattice;
use crate::lbm::Lbm;
use crate::openings::open_faces;
use crate::real::Real;
use crate::setup::{Face, Profile, Setup, SetupError};
use granular_core::{Dim, Linear, Motion, Section, SnapshotError};

/// A face whose velocity was set during the run.
#[derive(Clone, Debug)]
pub(crate) struct SetFace<D: Dim> {
    axis: usize,
    side: usize,
    /// As the setup had it.
    before: Face<D>,
    velocity: D::Vec,
}

/// Names of the low and the high face of each axis.
fn face_names<D: Dim>() -> &'static [[&'static str; 2]] {
    match D::N {
        2 => &[["left", "right"], ["bottom", "top"]],
        _ => &[["left", "right"], ["front", "back"], ["bottom", "top"]],
    }
}

impl<D: Dim> Setup<D> {
    /// Axis and side of a face by its name, as in `faces[axis][side]`: `left` and `right` along x, `bottom` and `top` along the
    /// axis that points up (y in the plane, z in space), `front` and `back` along y in space.
    ///
    /// # Errors
    /// When no face has that name; those that there are are listed.
    pub fn face_named(name: &str) -> Result<(usize, usize), SetupError> {
        let names = face_names::<D>();
        let found = names
            .iter()
            .enumerate()
            .find_map(|(axis, pair)| pair.iter().position(|other| *other == name).map(|side| (axis, side)));
        found.ok_or_else(|| {
            let list: Vec<&str> = names.iter().flatten().copied().collect();
            SetupError::new("name of a face", format!("`{name}`"), format!("one of {}", list.join(", ")))
        })
    }

    /// Number of the obstacle of this name.
    ///
    /// # Errors
    /// When no obstacle has that name; those that there are are listed.
    pub fn obstacle_named(&self, name: &str) -> Result<usize, SetupError> {
        self.obstacles.iter().position(|obstacle| obstacle.name == name).ok_or_else(|| {
            let list: Vec<String> =
                self.obstacles.iter().map(|obstacle| format!("`{}`", obstacle.name)).collect();
            let allowed = match list.is_empty() {
                true => "the name of an obstacle, of which there is none".to_owned(),
                false => format!("one of {}", list.join(", ")),
            };
            SetupError::new("name of an obstacle", format!("`{name}`"), allowed)
        })
    }

    /// Sets the velocity \[m/s\] of a face by its name, before the start: see [`Lbm::set_face_velocity`].
    ///
    /// # Errors
    /// As [`Lbm::set_face_velocity`].
    pub fn set_face_velocity(&mut self, name: &str, velocity: D::Vec) -> Result<(), SetupError> {
        let (axis, side) = Self::face_named(name)?;
        self.set_velocity_of(axis, side, velocity)
    }

    fn set_velocity_of(&mut self, axis: usize, side: usize, velocity: D::Vec) -> Result<(), SetupError> {
        let face = self.faces[axis][side].clone();
        let Some(moving) = face.moving(velocity) else {
            let value = format!("{face:?}, which has no velocity of its own");
            let allowed = "a wall, or a face through which fluid enters at a velocity";
            return Err(SetupError::new(format!("face `{}`", face_names::<D>()[axis][side]), value, allowed));
        };
        self.faces[axis][side] = moving;
        let checked = self.check_wall(axis, side).and_then(|()| {
            let error = || SetupError::new("velocity of a face", format!("{velocity:?}"), "finite numbers");
            velocity.is_finite().then_some(()).ok_or_else(error)
        });
        if checked.is_err() {
            self.faces[axis][side] = face;
        }
        checked
    }
}

impl<D: Dim> Face<D> {
    /// The same face with another velocity, the same all over it; none of a face that has no velocity.
    fn moving(&self, velocity: D::Vec) -> Option<Self> {
        match self {
            Self::Wall(_) | Self::WallProfile(_) => Some(Self::Wall(velocity)),
            Self::NavierSlip { length, .. } => Some(Self::NavierSlip { length: *length, velocity }),
            Self::Velocity(_, scheme) => Some(Self::Velocity(Profile::uniform(velocity), *scheme)),
            _ => None,
        }
    }
}

impl<L: Lattice<Q>, const Q: usize, T: Real> Lbm<L, Q, T> {
    /// Where the obstacle of this name is and how it moves.
    ///
    /// # Errors
    /// When no obstacle has that name.
    pub fn obstacle_motion(&self, name: &str) -> Result<Motion<L::Dim>, SetupError> {
        Ok(self.setup.obstacles[self.setup.obstacle_named(name)?].motion())
    }

    /// Puts the obstacle of this name somewhere, with a velocity \[m/s\] and a rate of turning \[1/s\] of its surface, from the next
    /// step on. Nothing moves by itself: set a place for each step, or lend a motion as couplings do. Cells that it leaves
    /// are filled at once.
    ///
    /// # Errors
    /// When no obstacle has that name, or the motion is not finite or faster than sound; nothing changes then.
    ///
    /// ```
    /// use granular_core::{Solver, glam::DVec2};
    /// use granular_lbm::{Ball, Lbm2, Obstacle, Setup};
    ///
    /// let mut setup = Setup::new([40, 40, 1], 1e-3, 1e-6, 0.8);
    /// setup.obstacles.push(Obstacle::new("disk", Ball { centre: DVec2::splat(0.02), radius: 6e-3 }));
    /// let dt = setup.time_step;
    /// let mut fluid = Lbm2::new(setup)?;
    /// let mut motion = fluid.obstacle_motion("disk")?;
    /// motion.spin = 0.1;
    /// fluid.set_obstacle_motion("disk", motion)?;
    /// fluid.advance(dt, 10)?;
    /// assert!(fluid.torque_on(0) < 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_obstacle_motion(&mut self, name: &str, motion: Motion<L::Dim>) -> Result<(), SetupError> {
        let number = self.setup.obstacle_named(name)?;
        let before = std::mem::replace(&mut self.motions[number], motion);
        self.may_have_moved = true;
        self.meet_moved_obstacles().map_err(|error| {
            self.motions[number] = before;
            let allowed = "a finite motion, slower than sound on the lattice";
            SetupError::new(format!("motion of obstacle `{name}`"), error.to_string(), allowed)
        })
    }

    /// Sets the velocity \[m/s\] of a face by its name (see [`Setup::face_named`]), the same all over it, from the next step
    /// on: of a wall, with slip or without, along itself, or of a face through which fluid enters at a velocity. Where it
    /// was set is part of the state that is saved.
    ///
    /// # Errors
    /// When no face has that name, it is of another kind, or the velocity is not finite or leads out of a wall; nothing
    /// changes then.
    ///
    /// ```
    /// use granular_core::{Solver, glam::DVec2};
    /// use granular_lbm::{Face, Lbm2, Setup};
    ///
    /// let mut setup = Setup::new([4, 9, 1], 1e-3, 1e-6, 0.8);
    /// setup.faces[1] = [Face::REST, Face::REST];
    /// let mut fluid = Lbm2::new(setup)?;
    /// fluid.set_face_velocity("top", DVec2::new(1e-3, 0.0))?;
    /// let none = fluid.set_face_velocity("back", DVec2::ZERO).unwrap_err();
    /// assert_eq!(none.to_string(), "name of a face is `back`; allowed: one of left, right, bottom, top");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_face_velocity(
        &mut self,
        name: &str,
        velocity: <L::Dim as Dim>::Vec,
    ) -> Result<(), SetupError> {
        let (axis, side) = Setup::<L::Dim>::face_named(name)?;
        self.set_velocity_of(axis, side, velocity)?;
        self.link_faces();
        Ok(())
    }

    fn set_velocity_of(
        &mut self,
        axis: usize,
        side: usize,
        velocity: <L::Dim as Dim>::Vec,
    ) -> Result<(), SetupError> {
        let before = self.setup.faces[axis][side].clone();
        self.setup.set_velocity_of(axis, side, velocity)?;
        match self.set_faces.iter_mut().find(|set| (set.axis, set.side) == (axis, side)) {
            Some(set) => set.velocity = velocity,
            None => self.set_faces.push(SetFace { axis, side, before, velocity }),
        }
        Ok(())
    }

    /// Finds the links of faces again.
    fn link_faces(&mut self) {
        let grid = &self.populations.grid;
        self.beyond.copies = Builder::<L, Q>::new(&self.setup, grid, &self.cover).copies();
        // What faces that absorb have learned of the flow holds as before.
        let seen = self.beyond.open.seen();
        self.beyond.open = open_faces::<L, Q>(&self.setup, grid, &self.cover);
        self.beyond.open.set_seen(&seen);
    }

    /// Saves which faces were set, and their velocities.
    pub(crate) fn save_faces(&self, to: &mut Section) {
        let sides = || (0..L::Dim::N).flat_map(|axis| [(axis, 0), (axis, 1)]);
        let set = |(axis, side)| self.set_faces.iter().find(|set| (set.axis, set.side) == (axis, side));
        let flags: Vec<f64> = sides().map(|face| f64::from(u8::from(set(face).is_some()))).collect();
        let velocities: Vec<_> =
            sides().map(|face| set(face).map_or(<L::Dim as Dim>::Vec::ZERO, |set| set.velocity)).collect();
        to.put("faces whose velocity was set", &flags);
        to.put("velocities set", &velocities);
    }

    /// Sets faces as they were saved.
    pub(crate) fn restore_faces(&mut self, from: &Section) -> Result<(), SnapshotError> {
        let count = 2 * L::Dim::N;
        let flags: Vec<f64> = from.array_of("faces whose velocity was set", count)?;
        let velocities: Vec<<L::Dim as Dim>::Vec> = from.array_of("velocities set", count)?;
        let damaged =
            |place: &str, found: String| SnapshotError::Damaged { place: format!("solver/{place}"), found };
        if let Some(flag) = flags.iter().find(|flag| **flag != 0.0 && **flag != 1.0) {
            return Err(damaged("faces whose velocity was set", format!("{flag} where 0 or 1 is expected")));
        }
        if !velocities.iter().all(|velocity| velocity.is_finite()) {
            return Err(damaged("velocities set", "a number that is not finite".to_owned()));
        }
        if self.set_faces.is_empty() && flags.iter().all(|flag| *flag == 0.0) {
            return Ok(());
        }
        for set in std::mem::take(&mut self.set_faces) {
            self.setup.faces[set.axis][set.side] = set.before;
        }
        for (number, velocity) in
            velocities.into_iter().enumerate().filter(|(number, _)| flags[*number] == 1.0)
        {
            self.set_velocity_of(number / 2, number % 2, velocity)
                .map_err(|error| damaged("velocities set", error.to_string()))?;
        }
        self.link_faces();
        Ok(())
    }
}
