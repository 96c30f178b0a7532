//! Walls that move: at a steady velocity, to and fro, turning, or under a force.
//!
//! A prescribed motion is a closed form of the time for which it has run, never a running sum: the wall is at
//! the same place after any split of a run and after any restart. A servo is a body of its own, see [`Servo`].

use crate::material::SetupError;
use crate::pose::{Pose, Rate, Turned};
use crate::servo::{Drive, Servo, Side};
use crate::wall::Wall;
use granular_core::{Dim, Linear, Section, SnapshotError};
use std::f64::consts::TAU;

/// How a wall moves, from where its shape was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WallMotion<D: Dim> {
    /// At a constant velocity.
    Steady {
        /// Velocity \[m/s\].
        velocity: D::Vec,
    },
    /// To and fro along a direction: shifted by `amplitude * (sin(2 pi f t + phase) - sin(phase))`, so that it
    /// begins where its shape was given.
    Oscillating {
        /// Greatest displacement \[m\], with its direction.
        amplitude: D::Vec,
        /// Frequency f \[Hz\].
        frequency: f64,
        /// Phase \[rad\] at which it begins.
        phase: f64,
    },
    /// Turning about a point.
    Turning {
        /// A point of the axis \[m\].
        about: D::Vec,
        /// Angular velocity \[rad/s\].
        spin: D::Spin,
    },
    /// Pressed by a force along a direction.
    Servo(Servo<D>),
}

impl<D: Dim> WallMotion<D> {
    /// Refuses values that are not finite and directions that are none.
    ///
    /// # Errors
    /// With the value that is out of range.
    pub fn check(&self, wall: &str) -> Result<(), SetupError> {
        let refuse = |what: &str, value: f64, allowed| {
            Err(SetupError::new(format!("{what} of wall `{wall}`"), value, allowed))
        };
        match self {
            Self::Steady { velocity } if !velocity.is_finite() => refuse("velocity", f64::NAN, "finite"),
            Self::Oscillating { amplitude, .. } if !amplitude.is_finite() => {
                refuse("amplitude", f64::NAN, "finite")
            }
            Self::Oscillating { frequency, .. } if !(frequency.is_finite() && *frequency >= 0.0) => {
                refuse("frequency", *frequency, "zero or more, and finite")
            }
            Self::Oscillating { phase, .. } if !phase.is_finite() => refuse("phase", *phase, "finite"),
            Self::Turning { about, spin } if !(about.is_finite() && spin.is_finite()) => {
                refuse("axis or spin", f64::NAN, "finite")
            }
            Self::Servo(servo) => servo.check(wall),
            _ => Ok(()),
        }
    }

    /// Greatest speed of a point at this distance \[m\] from where the wall was given; that of a servo follows
    /// from its state.
    fn fastest(&self, distance: impl FnOnce(D::Vec) -> f64) -> f64 {
        match self {
            Self::Steady { velocity } => velocity.length(),
            Self::Oscillating { amplitude, frequency, .. } => amplitude.length() * frequency * TAU,
            Self::Turning { about, spin } => spin.length() * distance(*about),
            Self::Servo(_) => 0.0,
        }
    }
}

/// The clock of a moving wall: how long it has moved.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Running {
    /// Time for which it moved before it was last started \[s\].
    before: f64,
    /// When it was last started \[s\]; not a number while it is held.
    since: f64,
}

impl Running {
    fn runs(self) -> bool {
        !self.since.is_nan()
    }

    fn elapsed(self, time: f64) -> f64 {
        if self.runs() { self.before + (time - self.since) } else { self.before }
    }
}

/// Push of the grains on a wall, and the power of the wall, over one step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reaction<D: Dim> {
    /// Force on the wall \[N\].
    pub(crate) force: D::Vec,
    /// Work of the wall on the grains per time \[W\].
    pub(crate) power: f64,
}

/// One wall that moves.
#[derive(Clone, Debug)]
struct Mover<D: Dim> {
    wall: usize,
    motion: WallMotion<D>,
    running: Running,
    drive: Drive,
    /// Sides of the area on which a pressure acts; none where a force is given.
    sides: Vec<Side<D>>,
    /// Distance of the farthest grain from the axis when lists were last built \[m\].
    reach: f64,
}

/// All walls that move, and where they are now.
#[derive(Clone, Debug, Default)]
pub(crate) struct Movers<D: Dim> {
    list: Vec<Mover<D>>,
    /// One for each wall; empty when none moves.
    pub(crate) poses: Vec<Pose<D>>,
    /// Push on each wall in the last step; empty when none moves.
    pub(crate) reactions: Vec<Reaction<D>>,
    /// Work of walls on grains since the start \[J\].
    pub(crate) work: f64,
}

impl<D: Dim> Movers<D> {
    pub(crate) fn of(walls: &[Wall<D>]) -> Result<Self, SetupError> {
        let mut list = Vec::new();
        for (wall, description) in walls.iter().enumerate() {
            let Some(motion) = description.motion else { continue };
            motion.check(&description.name)?;
            let running = Running { before: 0.0, since: if description.held { f64::NAN } else { 0.0 } };
            let sides = match motion {
                WallMotion::Servo(Servo { pressure: Some(pressure), .. }) => {
                    pressure.sides(&description.name, walls)?
                }
                _ => Vec::new(),
            };
            list.push(Mover { wall, motion, running, drive: Drive::default(), sides, reach: 0.0 });
        }
        let count = if list.is_empty() { 0 } else { walls.len() };
        let (poses, reactions) = (vec![Pose::default(); count], vec![Reaction::default(); count]);
        let mut movers = Self { list, poses, reactions, work: 0.0 };
        movers.place(0.0);
        Ok(movers)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Starts or holds a wall. Returns whether it is one that moves.
    pub(crate) fn set_running(&mut self, wall: usize, runs: bool, time: f64) -> bool {
        let Some(mover) = self.list.iter_mut().find(|mover| mover.wall == wall) else { return false };
        if runs != mover.running.runs() {
            let before = mover.running.elapsed(time);
            mover.running = Running { before, since: if runs { time } else { f64::NAN } };
            mover.drive = mover.drive.halted();
        }
        true
    }

    /// Poses at a time between steps \[s\].
    pub(crate) fn place(&mut self, time: f64) {
        for mover in &self.list {
            let pose = mover.at(time);
            self.poses[mover.wall] = Pose { start_rate: pose.rate, ..pose };
        }
    }

    /// Poses at the middle of the step that begins at `time`, and rates there and at its start.
    pub(crate) fn place_in_step(&mut self, time: f64, dt: f64) {
        for mover in &mut self.list {
            let start_rate = mover.at(time).rate;
            mover.drive = mover.drive.half_a_step(dt, &mover.motion, mover.running.runs());
            self.poses[mover.wall] = Pose { start_rate, ..mover.at(time + 0.5 * dt) };
        }
    }

    /// Takes the push of the grains over a step.
    pub(crate) fn take_reactions(&mut self, dt: f64, ledger: bool) {
        for mover in &mut self.list {
            let reaction = self.reactions[mover.wall];
            if ledger {
                self.work += reaction.power * dt;
            }
            if mover.running.runs() {
                let loads = (reaction.force, mover.pressed(&self.poses));
                mover.drive = mover.drive.other_half(dt, &mover.motion, loads);
            }
        }
    }

    /// Notes how far grains are from the axes of walls that turn.
    pub(crate) fn note_distances(&mut self, positions: &[D::Vec], beyond: f64) {
        for mover in &mut self.list {
            if let WallMotion::Turning { about, .. } = mover.motion {
                let farthest = positions.iter().map(|&x| (x - about).length()).fold(0.0, f64::max);
                mover.reach = farthest + beyond;
            }
        }
    }

    /// Greatest speed of any wall near a grain \[m/s\].
    pub(crate) fn fastest(&self, dt: f64) -> f64 {
        let speed = |mover: &Mover<D>| {
            if mover.running.runs() {
                mover.motion.fastest(|_| mover.reach).max(mover.drive.fastest(dt))
            } else {
                0.0
            }
        };
        self.list.iter().map(speed).fold(0.0, f64::max)
    }

    /// Greatest speed that a wall will have, as far as it is known before the run \[m/s\]; walls under a force
    /// count with the speed they have.
    pub(crate) fn fastest_ever(&self) -> f64 {
        let speed = |mover: &Mover<D>| mover.motion.fastest(|_| mover.reach).max(mover.drive.fastest(0.0));
        self.list.iter().map(speed).fold(0.0, f64::max)
    }

    /// Walls that move, and where each is: displacement, velocity and angle are those between steps.
    pub(crate) fn walls(&self) -> impl Iterator<Item = usize> {
        self.list.iter().map(|mover| mover.wall)
    }

    /// Angle by which a turning wall has turned \[rad\]; none for others.
    pub(crate) fn angle(&self, wall: usize, time: f64) -> Option<f64> {
        let mover = self.list.iter().find(|mover| mover.wall == wall)?;
        match mover.motion {
            WallMotion::Turning { spin, .. } => Some(spin.length() * mover.running.elapsed(time)),
            _ => None,
        }
    }

    /// Area on which the pressure of a servo acts now \[m^2; m in the plane\]; none where a force is given.
    pub(crate) fn pressed_area(&self, wall: usize) -> Option<f64> {
        let mover = self.list.iter().find(|mover| mover.wall == wall && !mover.sides.is_empty())?;
        Some(mover.area(&self.poses))
    }

    /// Walls under a force.
    pub(crate) fn servos(&self) -> impl Iterator<Item = (usize, &Servo<D>)> {
        self.list.iter().filter_map(|mover| match &mover.motion {
            WallMotion::Servo(servo) => Some((mover.wall, servo)),
            _ => None,
        })
    }

    pub(crate) fn save(&self, to: &mut Section) {
        if self.is_empty() {
            return;
        }
        let clocks: Vec<[f64; 3]> = self
            .list
            .iter()
            .map(|mover| {
                let runs = mover.running.runs();
                let since = if runs { mover.running.since } else { 0.0 };
                [f64::from(u8::from(runs)), mover.running.before, since]
            })
            .collect();
        let drives: Vec<[f64; 3]> = self.list.iter().map(|mover| mover.drive.to_array()).collect();
        to.put("clocks of moving walls", &clocks);
        to.put("servo walls", &drives);
        to.put_one("work of moving walls", self.work);
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        if self.is_empty() {
            return Ok(());
        }
        let clocks: Vec<[f64; 3]> = from.array_of("clocks of moving walls", self.list.len())?;
        let drives: Vec<[f64; 3]> = from.array_of("servo walls", self.list.len())?;
        let finite = |rows: &[[f64; 3]]| rows.iter().flatten().all(|value| value.is_finite());
        crate::grains::check_finite("clocks of moving walls", finite(&clocks))?;
        crate::grains::check_finite("servo walls", finite(&drives))?;
        for ((mover, [runs, before, since]), drive) in self.list.iter_mut().zip(clocks).zip(drives) {
            mover.running = Running { before, since: if runs == 0.0 { f64::NAN } else { since } };
            mover.drive = Drive::from_array(drive);
        }
        self.work = from.one("work of moving walls")?;
        crate::grains::check_finite("work of moving walls", self.work.is_finite())
    }
}

impl<D: Dim> Mover<D> {
    fn area(&self, poses: &[Pose<D>]) -> f64 {
        self.sides.iter().map(|side| side.length(poses)).product()
    }

    /// Force of a pressure on the area that there is now \[N\].
    fn pressed(&self, poses: &[Pose<D>]) -> f64 {
        match self.motion {
            WallMotion::Servo(Servo { pressure: Some(given), .. }) => given.pressure * self.area(poses),
            _ => 0.0,
        }
    }

    /// Where the wall is and how it moves at a time \[s\].
    fn at(&self, time: f64) -> Pose<D> {
        let elapsed = self.running.elapsed(time);
        let mut pose = Pose::default();
        match self.motion {
            WallMotion::Steady { velocity } => {
                pose.shift = velocity * elapsed;
                pose.rate.velocity = velocity;
            }
            WallMotion::Oscillating { amplitude, frequency, phase } => {
                let angle = TAU * frequency * elapsed + phase;
                pose.shift = amplitude * (angle.sin() - phase.sin());
                pose.rate.velocity = amplitude * (TAU * frequency * angle.cos());
            }
            WallMotion::Turning { about, spin } => {
                let rate = spin.length();
                pose.about = about;
                if rate > 0.0 {
                    pose.axis = spin * (1.0 / rate);
                    pose.angle = Turned::by(rate * elapsed);
                    pose.rate.spin = spin;
                }
            }
            WallMotion::Servo(servo) => {
                pose.shift = servo.direction * self.drive.offset;
                pose.rate.velocity = servo.direction * self.drive.now;
            }
        }
        if !self.running.runs() {
            pose.rate = Rate::default();
        }
        pose
    }
}
