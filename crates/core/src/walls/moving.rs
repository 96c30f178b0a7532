//! The state of walls that move.

use super::WallMotion;
use super::pose::{Pose, Rate, Turned};
use super::servo::{Drive, Servo, Side};
use crate::dim::{Dim, Linear};
use crate::setup_error::SetupError;
use crate::shape::Shape;
use crate::snapshot::{Section, SnapshotError, check_entry};
use std::f64::consts::TAU;

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

/// Push of what touches a wall, and the power of the wall, over one step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reaction<D: Dim> {
    /// Force on the wall \[N\].
    pub force: D::Vec,
    /// Work of the wall on them per time \[W\].
    pub power: f64,
}

/// One wall that moves.
#[derive(Clone, Debug)]
struct MovingWall<D: Dim> {
    wall: usize,
    motion: WallMotion<D>,
    running: Running,
    drive: Drive,
    /// Sides of the area on which a pressure acts; none where a force is given.
    sides: Vec<Side<D>>,
    /// Distance of the farthest position from the axis when they were last noted \[m\].
    reach: f64,
}

/// What the motion of walls needs to know of one.
#[derive(Clone, Copy, Debug)]
pub struct WallGeometry<'a, D: Dim> {
    /// Name, for messages.
    pub name: &'a str,
    /// Shape where it begins.
    pub shape: &'a Shape<D>,
    /// How it moves, if it does.
    pub motion: Option<WallMotion<D>>,
    /// Whether it waits where it is until [`MovingWalls::set_running`].
    pub held: bool,
}

/// All walls that move, and where they are now; empty, without cost, where none does.
#[derive(Clone, Debug, Default)]
pub struct MovingWalls<D: Dim> {
    list: Vec<MovingWall<D>>,
    /// One for each wall; empty when none moves.
    pub poses: Vec<Pose<D>>,
    /// Push on each wall in the last step; empty when none moves.
    pub reactions: Vec<Reaction<D>>,
    /// Work of walls on what touches them since the start \[J\].
    pub work: f64,
}

impl<D: Dim> MovingWalls<D> {
    /// Those of some walls that move.
    ///
    /// # Errors
    /// When a motion has a value that is out of range.
    pub fn of(walls: &[WallGeometry<'_, D>]) -> Result<Self, SetupError> {
        let shapes: Vec<&Shape<D>> = walls.iter().map(|wall| wall.shape).collect();
        let mut list = Vec::new();
        for (wall, description) in walls.iter().enumerate() {
            let Some(motion) = description.motion else { continue };
            motion.check(description.name)?;
            let running = Running { before: 0.0, since: if description.held { f64::NAN } else { 0.0 } };
            let sides = match motion {
                WallMotion::Servo(Servo { pressure: Some(pressure), .. }) => {
                    pressure.sides(description.name, &shapes)?
                }
                _ => Vec::new(),
            };
            list.push(MovingWall { wall, motion, running, drive: Drive::default(), sides, reach: 0.0 });
        }
        let count = if list.is_empty() { 0 } else { walls.len() };
        let (poses, reactions) = (vec![Pose::default(); count], vec![Reaction::default(); count]);
        let mut moving = Self { list, poses, reactions, work: 0.0 };
        moving.place(0.0);
        Ok(moving)
    }

    /// Whether no wall moves.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Starts or holds a wall. Returns whether it is one that moves.
    pub fn set_running(&mut self, wall: usize, runs: bool, time: f64) -> bool {
        let Some(mover) = self.list.iter_mut().find(|mover| mover.wall == wall) else { return false };
        if runs != mover.running.runs() {
            let before = mover.running.elapsed(time);
            mover.running = Running { before, since: if runs { time } else { f64::NAN } };
            mover.drive = mover.drive.halted();
        }
        true
    }

    /// Poses at a time between steps \[s\].
    pub fn place(&mut self, time: f64) {
        for mover in &self.list {
            let pose = mover.at(time);
            self.poses[mover.wall] = Pose { start_rate: pose.rate, ..pose };
        }
    }

    /// Poses at the middle of the step that begins at `time`, and rates there and at its start.
    pub fn place_in_step(&mut self, time: f64, dt: f64) {
        for mover in &mut self.list {
            let start_rate = mover.at(time).rate;
            mover.drive = mover.drive.half_a_step(dt, &mover.motion, mover.running.runs());
            self.poses[mover.wall] = Pose { start_rate, ..mover.at(time + 0.5 * dt) };
        }
    }

    /// Takes the push on each wall over a step, from [`MovingWalls::reactions`].
    pub fn take_reactions(&mut self, dt: f64, ledger: bool) {
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

    /// Notes how far positions \[m\] of what may touch walls are from the axes of those that turn; walls count `beyond` \[m\]
    /// farther.
    pub fn note_distances(&mut self, positions: &[D::Vec], beyond: f64) {
        for mover in &mut self.list {
            if let WallMotion::Turning { about, .. } = mover.motion {
                let farthest = positions.iter().map(|&x| (x - about).length()).fold(0.0, f64::max);
                mover.reach = farthest + beyond;
            }
        }
    }

    /// Greatest speed of any wall near what may touch it \[m/s\].
    pub fn fastest(&self, dt: f64) -> f64 {
        let speed = |mover: &MovingWall<D>| {
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
    pub fn fastest_ever(&self) -> f64 {
        let speed =
            |mover: &MovingWall<D>| mover.motion.fastest(|_| mover.reach).max(mover.drive.fastest(0.0));
        self.list.iter().map(speed).fold(0.0, f64::max)
    }

    /// Indices of walls that move.
    pub fn walls(&self) -> impl Iterator<Item = usize> {
        self.list.iter().map(|mover| mover.wall)
    }

    /// Angle by which a turning wall has turned \[rad\]; none for others.
    pub fn angle(&self, wall: usize, time: f64) -> Option<f64> {
        let mover = self.list.iter().find(|mover| mover.wall == wall)?;
        match mover.motion {
            WallMotion::Turning { spin, .. } => Some(spin.length() * mover.running.elapsed(time)),
            _ => None,
        }
    }

    /// Area on which the pressure of a servo acts now \[m^2; m in the plane\]; none where a force is given.
    pub fn pressed_area(&self, wall: usize) -> Option<f64> {
        let mover = self.list.iter().find(|mover| mover.wall == wall && !mover.sides.is_empty())?;
        Some(mover.area(&self.poses))
    }

    /// Indices of walls under a force, each with its servo.
    pub fn servos(&self) -> impl Iterator<Item = (usize, &Servo<D>)> {
        self.list.iter().filter_map(|mover| match &mover.motion {
            WallMotion::Servo(servo) => Some((mover.wall, servo)),
            _ => None,
        })
    }

    /// Adds the state of all motions to a section; nothing when no wall moves.
    pub fn save(&self, to: &mut Section) {
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

    /// Takes the state of all motions from a section.
    ///
    /// # Errors
    /// When an entry is missing or does not fit.
    pub fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        if self.is_empty() {
            return Ok(());
        }
        let clocks: Vec<[f64; 3]> = from.array_of("clocks of moving walls", self.list.len())?;
        let drives: Vec<[f64; 3]> = from.array_of("servo walls", self.list.len())?;
        let finite = |rows: &[[f64; 3]]| rows.iter().flatten().all(|value| value.is_finite());
        check_entry("clocks of moving walls", finite(&clocks))?;
        check_entry("servo walls", finite(&drives))?;
        for ((mover, [runs, before, since]), drive) in self.list.iter_mut().zip(clocks).zip(drives) {
            mover.running = Running { before, since: if runs == 0.0 { f64::NAN } else { since } };
            mover.drive = Drive::from_array(drive);
        }
        self.work = from.one("work of moving walls")?;
        check_entry("work of moving walls", self.work.is_finite())
    }
}

impl<D: Dim> MovingWall<D> {
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
