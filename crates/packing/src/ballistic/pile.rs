//! The pile that stands, and the way of one disk down to its place in it.
//!
//! While a disk rolls around an anchor, its centre moves on a circle of radius
//! `reach = radius + radius of the anchor` about the anchor, from the upper half down to the
//! height of the anchor, where it loses contact and falls. In this quarter the number
//! `s x - y` (s = 1 to the right, -1 to the left, relative to the anchor) grows from -reach to
//! +reach with a slope of at least reach per radian: it says how far the disk has come
//! without trigonometry and without loss of digits at either end.

use super::buckets::{Buckets, Member};
use super::{Sides, Support};
use granular_core::glam::DVec2;

/// Largest overlap that is accepted, over the smaller radius.
const OVERLAP: f64 = 1e-12;
/// A contact this part of the reach behind the disk is met now: round-off, not history.
const BEHIND: f64 = 1e-10;

/// A disk at rest or an image of it.
#[derive(Clone, Copy)]
struct Anchor {
    member: Member,
    centre: DVec2,
    radius: f64,
}

/// A disk that rolls: `sense` is 1 to the right, -1 to the left.
#[derive(Clone, Copy)]
struct Roll {
    anchor: Anchor,
    point: DVec2,
    sense: f64,
    /// The anchor before this one, which the disk has just left.
    left: Option<Member>,
    /// Whether the disk stood on top of the anchor and could not go the other way.
    turned: bool,
}

/// A place of rest.
pub(super) struct Rest {
    pub(super) point: DVec2,
    pub(super) supports: [Support; 2],
}

enum Step {
    Fall { from: DVec2, left: Option<Member> },
    Roll(Roll),
    Rest(Rest),
}

/// What ends a roll, the nearest so far.
struct Event {
    /// `s x - y` relative to the anchor.
    progress: f64,
    /// Centre of the disk relative to the anchor.
    offset: DVec2,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    LoseContact,
    Floor,
    Wall,
    Grain(Anchor),
}

/// The disks at rest.
pub(super) struct Pile {
    positions: Vec<DVec2>,
    radii: Vec<f64>,
    buckets: Buckets,
    width: f64,
    sides: Sides,
    largest: f64,
}

impl Pile {
    pub(super) fn new(count: usize, width: f64, sides: Sides, largest: f64) -> Self {
        Self {
            positions: Vec::with_capacity(count),
            radii: Vec::with_capacity(count),
            buckets: Buckets::new(count, width, 2.0 * largest, sides == Sides::Periodic),
            width,
            sides,
            largest,
        }
    }

    pub(super) fn into_positions(self) -> Vec<DVec2> {
        self.positions
    }

    /// Adds a disk at its place of rest.
    pub(super) fn add(&mut self, radius: f64, point: DVec2) {
        self.buckets.add(point.x, point.y);
        self.positions.push(point);
        self.radii.push(radius);
    }

    /// Drops a disk at `x`; `None` when round-off leaves an overlap at its place of rest or
    /// leads it in a circle.
    pub(super) fn settle(&self, radius: f64, x: f64) -> Option<Rest> {
        let mut step = Step::Fall { from: DVec2::new(x, f64::INFINITY), left: None };
        // Every step but a fall leads to a disk that was not touched before.
        for _ in 0..4 * self.radii.len() + 16 {
            step = match step {
                Step::Fall { from, left } => self.fall(radius, from, left),
                Step::Roll(roll) => self.roll(radius, roll),
                Step::Rest(rest) => {
                    let point = self.wrapped(rest.point);
                    return self.is_free(radius, point).then_some(Rest { point, ..rest });
                }
            };
        }
        None
    }

    fn anchor(&self, member: Member) -> Anchor {
        let shift = DVec2::new(member.image as f64 * self.width, 0.0);
        let index = member.index as usize;
        Anchor { member, centre: self.positions[index] + shift, radius: self.radii[index] }
    }

    /// Straight down from `from` onto the first disk or the floor. `left` is the disk that was
    /// lost at its equator: it touches the path and is not met.
    fn fall(&self, radius: f64, from: DVec2, left: Option<Member>) -> Step {
        let column = self.buckets.column(from.x);
        let mut rows = self.buckets.rows_in(column - 1, column + 1);
        if from.y.is_finite() {
            rows = rows.min(self.buckets.row(from.y) + 1);
        }
        let mut height = radius;
        let mut met = None;
        for row in (0..rows).rev() {
            self.buckets.visit_row(row, column - 1, column + 1, &mut |member| {
                let anchor = self.anchor(member);
                let (reach, aside) = (radius + anchor.radius, from.x - anchor.centre.x);
                if aside.abs() >= reach || anchor.centre.y >= from.y || Some(member) == left {
                    return;
                }
                let contact = anchor.centre.y + ((reach - aside) * (reach + aside)).sqrt();
                if contact > height {
                    (height, met) = (contact, Some(anchor));
                }
            });
            // A disk of a lower row reaches at most a row higher than its own top.
            if height >= self.buckets.top(row) {
                break;
            }
        }
        let point = DVec2::new(from.x, height);
        match met {
            None => Step::Rest(Rest { point, supports: [Support::Floor; 2] }),
            Some(anchor) => {
                let sense = self.sense(point, anchor);
                Step::Roll(Roll { anchor, point, sense, left: None, turned: false })
            }
        }
    }

    /// Down is away from the anchor; from exactly above it, towards the middle of the box.
    fn sense(&self, point: DVec2, anchor: Anchor) -> f64 {
        let aside = point.x - anchor.centre.x;
        let aside = if aside == 0.0 { 0.5 * self.width - self.wrapped(point).x } else { aside };
        if aside > 0.0 { 1.0 } else { -1.0 }
    }

    /// Around the anchor until something is met or the contact is lost.
    fn roll(&self, radius: f64, roll: Roll) -> Step {
        let Roll { anchor, sense, .. } = roll;
        let event = self.first_event(radius, &roll);
        let point = anchor.centre + event.offset;
        let support = Support::Grain(anchor.member.index);
        let other = match event.kind {
            Kind::LoseContact => return Step::Fall { from: point, left: Some(anchor.member) },
            Kind::Floor => {
                let point = DVec2::new(point.x, radius);
                return Step::Rest(Rest { point, supports: [Support::Floor; 2] });
            }
            Kind::Wall if sense > 0.0 => Support::RightWall,
            Kind::Wall => Support::LeftWall,
            Kind::Grain(other) if sense * (other.centre.x - point.x) > 0.0 => {
                Support::Grain(other.member.index)
            }
            // Both lie on the same side: the lower one takes over.
            Kind::Grain(other) => {
                let left = Some(anchor.member);
                return Step::Roll(Roll { anchor: other, point, sense, left, turned: false });
            }
        };
        // On top of the anchor, but for round-off: what stops the disk here is no support.
        let on_top = sense * event.offset.x <= BEHIND * (radius + anchor.radius);
        if on_top && !roll.turned {
            return Step::Roll(Roll { sense: -sense, left: None, turned: true, ..roll });
        }
        Step::Rest(Rest { point, supports: [support, other] })
    }

    /// The first of all that the disk meets on its way around the anchor.
    fn first_event(&self, radius: f64, roll: &Roll) -> Event {
        let Roll { anchor, point, sense, left, .. } = *roll;
        let reach = radius + anchor.radius;
        let start = point - anchor.centre;
        let earliest = sense * start.x - start.y - BEHIND * reach;
        let equator = DVec2::new(sense * reach, 0.0);
        let mut event = Event { progress: reach, offset: equator, kind: Kind::LoseContact };
        let mut consider = |offset: DVec2, kind: Kind| {
            let progress = sense * offset.x - offset.y;
            // The upper quarter ahead only: behind it, progress would begin to count anew.
            let ahead = offset.y >= 0.0 && sense * offset.x >= -BEHIND * reach;
            if ahead && progress >= earliest && progress < event.progress {
                event = Event { progress, offset, kind };
            }
        };
        let floor = radius - anchor.centre.y;
        if floor >= 0.0 {
            consider(DVec2::new(sense * other_leg(reach, floor), floor), Kind::Floor);
        }
        if self.sides == Sides::Walls {
            let wall = if sense > 0.0 { self.width - radius } else { radius };
            let aside = wall - anchor.centre.x;
            if aside.abs() <= reach {
                consider(DVec2::new(aside, other_leg(reach, aside)), Kind::Wall);
            }
        }
        // The corners of the way of the centre, wider by what can touch the disk.
        let (end, margin) = (anchor.centre + equator, DVec2::splat(radius + self.largest));
        let (low, high) = (point.min(end) - margin, point.max(end) + margin);
        self.buckets.visit_box(low.into(), high.into(), &mut |member| {
            if member != anchor.member && Some(member) != left {
                let other = self.anchor(member);
                if let Some(offset) =
                    meeting(other.centre - anchor.centre, reach, radius + other.radius, sense)
                {
                    consider(offset, Kind::Grain(other));
                }
            }
        });
        event
    }

    /// The point moved into the box by whole widths.
    fn wrapped(&self, point: DVec2) -> DVec2 {
        if self.sides == Sides::Walls {
            return point;
        }
        let x = point.x.rem_euclid(self.width);
        // The remainder of a tiny negative number is the width itself.
        DVec2::new(if x < self.width { x } else { 0.0 }, point.y)
    }

    /// Whether a disk at this place overlaps nothing by more than the accepted part.
    fn is_free(&self, radius: f64, point: DVec2) -> bool {
        let round_off = 4.0 * f64::EPSILON * point.x.abs().max(point.y.abs()).max(self.width);
        let mut free = point.y >= radius * (1.0 - OVERLAP) - round_off;
        if self.sides == Sides::Walls {
            let accepted = radius * (1.0 - OVERLAP) - round_off;
            free &= point.x >= accepted && self.width - point.x >= accepted;
        }
        let margin = DVec2::splat(radius + self.largest);
        self.buckets.visit_box((point - margin).into(), (point + margin).into(), &mut |member| {
            let other = self.anchor(member);
            let gap = (other.centre - point).length() - radius - other.radius;
            free &= gap >= -OVERLAP * radius.min(other.radius) - round_off;
        });
        free
    }
}

/// The other leg of a right triangle.
fn other_leg(hypotenuse: f64, leg: f64) -> f64 {
    ((hypotenuse - leg) * (hypotenuse + leg)).max(0.0).sqrt()
}

/// Where a point on the circle of radius `reach` about the origin, moving clockwise
/// (`sense` 1) or counter-clockwise (-1), enters the circle of radius `other_reach` about `to`.
fn meeting(to: DVec2, reach: f64, other_reach: f64, sense: f64) -> Option<DVec2> {
    let distance = to.length();
    let along = 0.5 * (distance + (reach - other_reach) * (reach + other_reach) / distance);
    if along.abs() >= reach {
        return None;
    }
    let direction = to / distance;
    Some(direction * along + direction.perp() * (sense * other_leg(reach, along)))
}
