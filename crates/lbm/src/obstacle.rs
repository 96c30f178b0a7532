//! Bodies in the fluid, and which cells they cover.

use crate::links::WallScheme;
use crate::setup::{Face, Setup, SetupError};
use granular_core::shape::SolidShape;
use granular_core::{Dim, Linear, Motion, Vector};
use std::fmt;
use std::sync::Arc;

/// A body in the fluid, on which force and torque are measured.
#[derive(Clone)]
pub struct Obstacle<D: Dim> {
    /// Name, for `force_on_<name>_x`.
    pub name: String,
    /// Shape, where it was made.
    pub shape: Arc<dyn SolidShape<D>>,
    /// How its surface is met.
    pub wall: WallScheme,
    /// How far the shape has moved from where it was made \[m\].
    pub displacement: D::Vec,
    /// Velocity of its surface \[m/s\]. It moves nothing by itself: a motion lent to the fluid does.
    pub velocity: D::Vec,
    /// Rate of turning of its surface \[1/s\]. Shapes do not turn with it: it suits disks and spheres.
    pub spin: D::Spin,
    /// What forces are shown over, as `drag_coefficient_of_<name>` (along x) and `lift_coefficient_of_<name>` (along y).
    pub reference: Option<Reference>,
}

/// Speed and length that make a force a coefficient: `2 F / (density speed^2 length)` in the plane, where forces are per
/// metre of depth, and `length^2` in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Speed \[m/s\].
    pub speed: f64,
    /// Length \[m\]; in space the root of an area.
    pub length: f64,
}

impl<D: Dim> Obstacle<D> {
    /// A body at rest with interpolated wall.
    pub fn new(name: impl Into<String>, shape: impl SolidShape<D> + 'static) -> Self {
        Self {
            name: name.into(),
            shape: Arc::new(shape),
            wall: WallScheme::default(),
            displacement: D::Vec::ZERO,
            velocity: D::Vec::ZERO,
            spin: D::Spin::ZERO,
            reference: None,
        }
    }

    /// Whether shape, motion and reference make sense.
    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let of = |what: &str| format!("{what} of obstacle `{}`", self.name);
        self.shape.check().map_err(|error| SetupError::new(of(&error.what), error.value, error.allowed))?;
        let motion = [
            ("displacement", self.displacement.is_finite(), format!("{:?} m", self.displacement)),
            ("velocity", self.velocity.is_finite(), format!("{:?} m/s", self.velocity)),
            ("spin", self.spin.is_finite(), format!("{:?} 1/s", self.spin)),
        ];
        if let Some((what, _, value)) = motion.into_iter().find(|(_, is_finite, _)| !is_finite) {
            return Err(SetupError::new(of(what), value, "finite numbers"));
        }
        match self.reference {
            Some(Reference { speed, length })
                if !(speed > 0.0 && length > 0.0 && speed.is_finite() && length.is_finite()) =>
            {
                Err(SetupError::new(of("reference"), format!("{speed} m/s, {length} m"), "positive numbers"))
            }
            _ => Ok(()),
        }
    }

    /// Where it is and how it moves.
    pub fn motion(&self) -> Motion<D> {
        let position = self.shape.centre() + self.displacement;
        Motion::new(position, self.velocity, self.spin)
    }

    /// Takes a motion, whose place may lie periods away.
    pub(crate) fn set_motion(&mut self, motion: Motion<D>, domain: &Domain<D>) {
        self.displacement = domain.wrapped(motion.position, self) - self.shape.centre();
        (self.velocity, self.spin) = (motion.velocity, motion.spin);
    }

    /// Velocity \[m/s\] of its surface or inside at a point away from its centre \[m\].
    pub(crate) fn velocity_at(&self, arm: D::Vec) -> D::Vec {
        self.velocity + D::turn(self.spin, arm)
    }
}

impl<D: Dim> fmt::Debug for Obstacle<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Obstacle").field("name", &self.name).field("wall", &self.wall).finish_non_exhaustive()
    }
}

/// Where the cells are, and along which axes the domain repeats.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Domain<D: Dim> {
    pub(crate) origin: D::Vec,
    pub(crate) spacing: f64,
    pub(crate) cells: [usize; 3],
    pub(crate) is_periodic: [bool; 3],
}

/// A box of cells, its end excluded.
pub(crate) type Range = [[usize; 3]; 2];

impl<D: Dim> Domain<D> {
    pub(crate) fn of(setup: &Setup<D>) -> Self {
        let is_periodic = std::array::from_fn(|axis| matches!(setup.faces[axis][0], Face::Periodic));
        Self { origin: setup.origin, spacing: setup.spacing, cells: setup.cells, is_periodic }
    }

    fn length(&self, axis: usize) -> f64 {
        self.cells[axis] as f64 * self.spacing
    }

    /// Axes along which an obstacle is repeated: one without end has no images there.
    fn repeating(&self, obstacle: &Obstacle<D>) -> impl Iterator<Item = usize> {
        let (low, high) = obstacle.shape.bounds();
        let is_periodic = self.is_periodic;
        (0..D::N).filter(move |axis| is_periodic[*axis] && (high - low).component(*axis).is_finite())
    }

    /// The point in the domain of which this one \[m\] is a periodic image, for the centre of an obstacle.
    fn wrapped(&self, mut point: D::Vec, obstacle: &Obstacle<D>) -> D::Vec {
        for axis in self.repeating(obstacle) {
            let periods = ((point - self.origin).component(axis) / self.length(axis)).floor();
            point -= D::Vec::along(axis, periods * self.length(axis));
        }
        point
    }

    /// Displacements \[m\] at which an obstacle and its periodic images reach into the domain, `margin` cells wider.
    pub(crate) fn images(&self, obstacle: &Obstacle<D>, margin: f64) -> Vec<D::Vec> {
        let mut images = vec![obstacle.displacement];
        for axis in self.repeating(obstacle) {
            let period = D::Vec::along(axis, self.length(axis));
            images = images.into_iter().flat_map(|image| [image, image - period, image + period]).collect();
        }
        images.retain(|image| {
            let [low, high] = self.near(obstacle, *image, margin);
            (0..D::N).all(|axis| low[axis] < high[axis])
        });
        images
    }

    /// Centre \[m\] of the image of an obstacle nearest to a point \[m\].
    pub(crate) fn nearest_image(&self, obstacle: &Obstacle<D>, point: D::Vec) -> D::Vec {
        let mut centre = obstacle.shape.centre() + obstacle.displacement;
        for axis in self.repeating(obstacle) {
            let periods = ((point - centre).component(axis) / self.length(axis)).round();
            centre += D::Vec::along(axis, periods * self.length(axis));
        }
        centre
    }

    /// Cells of a box around an image of an obstacle, `margin` cells wider, cut to the domain.
    pub(crate) fn near(&self, obstacle: &Obstacle<D>, image: D::Vec, margin: f64) -> Range {
        let (low, high) = obstacle.shape.bounds();
        let mut range = [[0; 3], self.cells];
        for axis in 0..D::N {
            let at = |corner: D::Vec| (corner + image - self.origin).component(axis) / self.spacing;
            let last = self.cells[axis] as f64;
            range[0][axis] = (at(low) - 1.0 - margin).floor().clamp(0.0, last) as usize;
            range[1][axis] = (at(high) + 1.0 + margin).ceil().clamp(0.0, last) as usize;
        }
        range
    }

    /// Whether a box of cells comes within two cells of the end of the domain.
    pub(crate) fn is_at_face(&self, [low, high]: Range) -> bool {
        (0..D::N).any(|axis| low[axis] < 2 || high[axis] + 2 > self.cells[axis])
    }

    /// Centre of a cell \[m\]; coordinates may lie beyond the domain.
    pub(crate) fn centre(&self, cell: [i64; 3]) -> D::Vec {
        let mut centre = self.origin;
        for (axis, &at) in cell.iter().enumerate().take(D::N) {
            centre += D::Vec::along(axis, (at as f64 + 0.5) * self.spacing);
        }
        centre
    }
}

/// Number of the obstacle that covers a cell, from 1; 0 is fluid. Empty without obstacles.
pub(crate) type Cover = Vec<u16>;

/// Index of a cell among all of the domain.
pub(crate) fn cell_index([nx, ny, _]: [usize; 3], [x, y, z]: [usize; 3]) -> usize {
    (z * ny + y) * nx + x
}

/// All cells of a box, x fastest.
pub(crate) fn cells_of([low, high]: Range) -> impl Iterator<Item = [usize; 3]> {
    (low[2]..high[2])
        .flat_map(move |z| (low[1]..high[1]).flat_map(move |y| (low[0]..high[0]).map(move |x| [x, y, z])))
}

/// Marks the cells whose centres obstacles contain; the first obstacle keeps a cell.
pub(crate) fn cover<D: Dim>(setup: &Setup<D>) -> Result<Cover, SetupError> {
    if setup.obstacles.is_empty() {
        return Ok(Vec::new());
    }
    if u16::try_from(setup.obstacles.len()).is_err() {
        let value = format!("{} bodies", setup.obstacles.len());
        return Err(SetupError::new("obstacles", value, "at most 65535"));
    }
    let domain = Domain::of(setup);
    let mut cover = vec![0; setup.cells.iter().product()];
    for (number, obstacle) in (1..).zip(&setup.obstacles) {
        for image in domain.images(obstacle, 0.0) {
            for cell in cells_of(domain.near(obstacle, image, 0.0)) {
                let at = cell_index(setup.cells, cell);
                let centre = domain.centre(cell.map(|x| x as i64));
                if cover[at] == 0 && obstacle.shape.contains(centre - image) {
                    cover[at] = number;
                }
            }
        }
    }
    if cover.iter().all(|number| *number != 0) {
        return Err(SetupError::new(
            "fluid",
            "covered by obstacles everywhere".to_owned(),
            "some cells free",
        ));
    }
    Ok(cover)
}
