//! What a flow is made of, in physical units.

use crate::body_force::BodyForce;
use crate::collision::Operator;
use crate::gauge::Gauge;
use crate::obstacle::Obstacle;
use crate::obstacle::{Domain, cells_of};
use crate::open::OpenScheme;
use granular_core::shape::ShapeError;
use granular_core::{Dim, Linear, Vector as _};
use std::collections::HashSet;
use std::fmt;
use std::sync::Arc;

/// A flow to be solved. Fields are public; start from [`Setup::new`].
#[derive(Clone)]
pub struct Setup<D: Dim> {
    /// Cells along each axis; 1 along z in the plane.
    pub cells: [usize; 3],
    /// Edge of a cell \[m\].
    pub spacing: f64,
    /// Lowest corner of the domain \[m\].
    pub origin: D::Vec,
    /// Step \[s\].
    pub time_step: f64,
    /// Kinematic viscosity \[m^2/s\].
    pub viscosity: f64,
    /// Density \[kg/m^3\].
    pub density: f64,
    /// Body force per mass \[m/s^2\]; its force density is that of the density given, not of the local one.
    pub acceleration: D::Vec,
    /// What pressure means where the acceleration is a weight; whole by default.
    pub pressure: PressureLevel,
    /// A body force that varies in space or time, beside the acceleration; none by default.
    pub body_force: Option<BodyForce<D>>,
    /// Collision operator.
    pub operator: Operator,
    /// Smagorinsky constant C of the eddy viscosity `(C h)^2 sqrt(2 S:S)`; none by default.
    pub smagorinsky: Option<f64>,
    /// What bounds the domain: low and high face of each axis.
    pub faces: [[Face<D>; 2]; 3],
    /// Bodies in the fluid.
    pub obstacles: Vec<Obstacle<D>>,
    /// Points at which pressure and velocity are shown.
    pub gauges: Vec<Gauge<D>>,
    /// Largest speed that is expected \[m/s\], for the bound on the Mach number where it does not follow from faces and obstacles.
    pub expected_speed: f64,
}

/// What the pressure of a fluid under a constant acceleration means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PressureLevel {
    /// It is whole and grows with depth, and density with it. A fluid that begins with the same pressure everywhere sinks into
    /// itself at first and sloshes as sound.
    #[default]
    Whole,
    /// It is that above the hydrostatic one. The acceleration acts along periodic axes only, as it would be balanced along
    /// others by the part of the pressure that is left out; immersed grains learn of it whole, for their buoyancy, and obstacles
    /// have none.
    AboveHydrostatic,
}

/// One face of the domain.
#[derive(Clone)]
pub enum Face<D: Dim> {
    /// What leaves here enters through the face opposite.
    Periodic,
    /// A wall at the face, half a cell beyond the centres of the last cells, with a velocity along
    /// itself \[m/s\].
    Wall(D::Vec),
    /// The same with a velocity along itself \[m/s\] that varies: at each point \[m\] at which a link to a cell beyond meets
    /// the wall, such as a lid that is at rest in its corners. In a corner of the domain the wall that moves less counts.
    WallProfile(Profile<D>),
    /// A wall along which the fluid slips: its velocity less that of the wall is the slip length times the derivative of
    /// the velocity across the wall (Navier's condition). See [`Face::slipping`].
    NavierSlip {
        /// Slip length \[m\]: zero for a wall that does not slip.
        length: f64,
        /// Velocity of the wall along itself \[m/s\].
        velocity: D::Vec,
    },
    /// No flow through and no friction along the face.
    FreeSlip,
    /// Velocity \[m/s\] at the centres of the last cells.
    Velocity(Profile<D>, OpenScheme),
    /// Pressure over that at rest \[Pa\] at the centres of the last cells; flow along the face is zero.
    Pressure(f64, OpenScheme),
    /// The same, with a velocity \[m/s\] of which the part along the face is given.
    PressureAlong(f64, Profile<D>, OpenScheme),
    /// Sound leaves, and the pressure settles at a given one: a face at given pressure throws sound back. See
    /// [`Face::absorbing`].
    Absorbing {
        /// Pressure over that at rest \[Pa\] to which the face settles.
        pressure: f64,
        /// How fast, in units of the speed of sound over the length of the domain across the face: the
        /// faster, the more sound of long waves comes back.
        relaxation: f64,
    },
}

impl<D: Dim> Face<D> {
    /// A wall at rest.
    pub const REST: Self = Self::Wall(D::Vec::ZERO);

    /// A wall at rest with a slip length \[m\].
    ///
    /// Of what leaves towards the wall the share `r = (tau - 1/2) / (length / h + tau - 1/2)` comes back the way it came,
    /// the rest is mirrored. For a flow along the face the slip length is exactly the one given, whatever the operator and
    /// the relaxation time; a curved profile has the error of a wall beside it, `(16 Lambda - 3) / 24` times the second
    /// derivative, which is zero at `Lambda = 3/16`. With a closure `tau` is that without eddy viscosity.
    pub const fn slipping(length: f64) -> Self {
        Self::NavierSlip { length, velocity: D::Vec::ZERO }
    }

    /// A face that lets sound leave and settles at a pressure over that at rest \[Pa\], with the relaxation of
    /// 0.25 that \[PoinsotLele1992\] used.
    ///
    /// Of a wave of angular frequency `w` the share `1 / sqrt(1 + (w L / (0.25 c_s))^2)` comes back, `L` being the length of
    /// the domain across the face: what holds the level of pressure throws long waves back. A pulse of standard
    /// deviation L/15 comes back by 4 %, from a given pressure by 98 %. In a steady flow the mean pressure at the face comes
    /// to be the one given: what estimates of friction there miss is learned, within a few times `L / (0.25 c_s)`.
    pub const fn absorbing(pressure: f64) -> Self {
        Self::Absorbing { pressure, relaxation: 0.25 }
    }

    /// Whether fluid passes to or from outside.
    pub(crate) fn is_open(&self) -> bool {
        self.scheme().is_some()
    }

    /// The scheme of an open face.
    pub(crate) fn scheme(&self) -> Option<OpenScheme> {
        match self {
            Self::Velocity(_, scheme) | Self::Pressure(_, scheme) | Self::PressureAlong(_, _, scheme) => {
                Some(*scheme)
            }
            // Rebuilding the populations there was tried: it grows without bound.
            Self::Absorbing { .. } => Some(OpenScheme::ZouHe),
            _ => None,
        }
    }

    /// The pressure \[Pa\] that is given, at once or in the end.
    pub(crate) fn pressure(&self) -> Option<f64> {
        match self {
            Self::Pressure(pressure, _)
            | Self::PressureAlong(pressure, ..)
            | Self::Absorbing { pressure, .. } => Some(*pressure),
            _ => None,
        }
    }

    /// The velocity that is given.
    pub(crate) fn profile(&self) -> Option<&Profile<D>> {
        match self {
            Self::Velocity(profile, _) | Self::PressureAlong(_, profile, _) => Some(profile),
            _ => None,
        }
    }
}

impl<D: Dim> fmt::Debug for Face<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Periodic => f.write_str("Periodic"),
            Self::Wall(velocity) => write!(f, "Wall({velocity:?})"),
            Self::WallProfile(_) => f.write_str("WallProfile(..)"),
            Self::NavierSlip { length, velocity } => write!(f, "NavierSlip({length}, {velocity:?})"),
            Self::FreeSlip => f.write_str("FreeSlip"),
            Self::Velocity(_, scheme) => write!(f, "Velocity(.., {scheme:?})"),
            Self::Pressure(pressure, scheme) => write!(f, "Pressure({pressure}, {scheme:?})"),
            Self::PressureAlong(pressure, _, scheme) => {
                write!(f, "PressureAlong({pressure}, .., {scheme:?})")
            }
            Self::Absorbing { pressure, relaxation } => write!(f, "Absorbing({pressure}, {relaxation})"),
        }
    }
}

/// A velocity \[m/s\] at each point \[m\] of a face.
#[derive(Clone)]
pub struct Profile<D: Dim>(pub(crate) Arc<dyn Fn(D::Vec) -> D::Vec + Send + Sync>);

impl<D: Dim> Profile<D> {
    /// From a function.
    pub fn new(velocity: impl Fn(D::Vec) -> D::Vec + Send + Sync + 'static) -> Self {
        Self(Arc::new(velocity))
    }

    /// Velocity \[m/s\] at a point \[m\].
    pub fn at(&self, point: D::Vec) -> D::Vec {
        (self.0)(point)
    }

    /// The same velocity everywhere.
    pub fn uniform(velocity: D::Vec) -> Self {
        Self::new(move |_| velocity)
    }
}

impl<D: Dim> fmt::Debug for Setup<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Setup")
            .field("cells", &self.cells)
            .field("spacing", &self.spacing)
            .field("time_step", &self.time_step)
            .field("viscosity", &self.viscosity)
            .field("operator", &self.operator)
            .field("faces", &self.faces)
            .field("obstacles", &self.obstacles)
            .finish_non_exhaustive()
    }
}

impl<D: Dim> Setup<D> {
    /// Fluid of viscosity \[m^2/s\] in a periodic domain of `cells`, each of edge `spacing` \[m\], with
    /// density 1000 kg/m^3 and a step \[s\] such that the relaxation time is `tau` steps.
    pub fn new(cells: [usize; 3], spacing: f64, viscosity: f64, tau: f64) -> Self {
        let faces = std::array::from_fn(|_| [Face::Periodic, Face::Periodic]);
        Self {
            cells,
            spacing,
            origin: D::Vec::ZERO,
            time_step: (tau - 0.5) * spacing * spacing / (3.0 * viscosity),
            viscosity,
            density: 1000.0,
            acceleration: D::Vec::ZERO,
            pressure: PressureLevel::default(),
            body_force: None,
            operator: Operator::DEFAULT,
            smagorinsky: None,
            faces,
            obstacles: Vec::new(),
            gauges: Vec::new(),
            expected_speed: 0.0,
        }
    }

    /// Relaxation time in steps: `1/2 + 3 nu dt / h^2`.
    pub fn tau(&self) -> f64 {
        0.5 + 3.0 * self.viscosity * self.time_step / (self.spacing * self.spacing)
    }

    /// One cell per step \[m/s\].
    pub fn lattice_speed(&self) -> f64 {
        self.spacing / self.time_step
    }

    /// The part of the acceleration that acts on cells \[m/s^2\].
    pub(crate) fn acting_acceleration(&self) -> [f64; 3] {
        let whole = self.acceleration.padded();
        std::array::from_fn(|axis| {
            let is_periodic = matches!(self.faces[axis][0], Face::Periodic);
            let acts = is_periodic || self.pressure == PressureLevel::Whole;
            if acts { whole[axis] } else { 0.0 }
        })
    }

    pub(crate) fn check(&self) -> Result<(), SetupError> {
        let positive = [
            ("spacing", self.spacing, "m"),
            ("time step", self.time_step, "s"),
            ("viscosity", self.viscosity, "m^2/s"),
            ("density", self.density, "kg/m^3"),
        ];
        for (what, value, unit) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SetupError::new(what, format!("{value} {unit}"), "a positive number"));
            }
        }
        for axis in 0..3 {
            let (cells, least) = (self.cells[axis], if axis < D::N { 2 } else { 1 });
            if cells < least || (axis >= D::N && cells != 1) {
                let allowed = if axis < D::N { "at least 2" } else { "1 along z in the plane" };
                return Err(SetupError::new("cells", format!("{cells} along axis {axis}"), allowed));
            }
            self.check_faces(axis)?;
        }
        if let Some(constant) = self.smagorinsky
            && !(constant >= 0.0 && constant.is_finite())
        {
            return Err(SetupError::new("Smagorinsky constant", constant.to_string(), "zero or more"));
        }
        if !self.acceleration.is_finite() || !self.origin.is_finite() {
            return Err(SetupError::new("acceleration or origin", "not finite".to_owned(), "finite numbers"));
        }
        if !(self.expected_speed >= 0.0 && self.expected_speed.is_finite()) {
            let value = format!("{} m/s", self.expected_speed);
            return Err(SetupError::new("expected speed", value, "zero or more"));
        }
        self.check_open_faces()?;
        self.check_named()?;
        self.check_rates()
    }

    /// Obstacles and gauges, and their names.
    fn check_named(&self) -> Result<(), SetupError> {
        self.obstacles.iter().try_for_each(Obstacle::check)?;
        if let Some(gauge) = self.gauges.iter().find(|gauge| !gauge.place.is_finite()) {
            let value = format!("{:?}", gauge.place);
            return Err(SetupError::new(format!("place of gauge `{}`", gauge.name), value, "finite numbers"));
        }
        let obstacles = self.obstacles.iter().map(|obstacle| ("name of an obstacle", &obstacle.name));
        let gauges = self.gauges.iter().map(|gauge| ("name of a gauge", &gauge.name));
        let mut names = HashSet::new();
        match obstacles.chain(gauges).find(|named| !names.insert(*named)) {
            Some((what, name)) => Err(SetupError::new(what, format!("`{name}` again"), "a name of its own")),
            None => Ok(()),
        }
    }

    fn check_faces(&self, axis: usize) -> Result<(), SetupError> {
        let [low, high] = &self.faces[axis];
        let is_periodic = |face: &Face<D>| matches!(face, Face::Periodic);
        if is_periodic(low) != is_periodic(high) {
            return Err(SetupError::new(
                "faces",
                format!("one periodic face along axis {axis}"),
                "both or none of a pair periodic",
            ));
        }
        [0, 1].into_iter().try_for_each(|side| self.check_wall(axis, side))
    }

    /// What open faces give must be finite, and something must set the level of the pressure.
    fn check_open_faces(&self) -> Result<(), SetupError> {
        let faces = || self.faces.iter().flatten();
        if let Some(pressure) = faces().filter_map(Face::pressure).find(|pressure| !pressure.is_finite()) {
            return Err(SetupError::new("pressure of a face", format!("{pressure} Pa"), "a finite number"));
        }
        let has_velocity = faces().any(|face| matches!(face, Face::Velocity(..)));
        if has_velocity && faces().all(|face| face.pressure().is_none()) {
            return Err(SetupError::new(
                "faces",
                "velocity on every open face, so that nothing sets the level of pressure and what flows in need not \
                 flow out"
                    .to_owned(),
                "a pressure on one open face at least",
            ));
        }
        for axis in 0..D::N {
            // What is carried over to an edge or an absorbing face must not come from the face opposite.
            if self.cells[axis] < 3 && self.faces[axis].iter().all(Face::is_open) {
                let value = format!("{} between open faces along axis {axis}", self.cells[axis]);
                return Err(SetupError::new("cells", value, "at least 3"));
            }
            for (side, face) in self.faces[axis].iter().enumerate() {
                let cells = self.cells[axis] as f64;
                if let Face::Absorbing { relaxation, .. } = face
                    && !(*relaxation > 0.0 && *relaxation <= 0.5 * cells)
                {
                    let allowed = format!("above 0, at most half of the {cells} cells across; such as 0.25");
                    return Err(SetupError::new("relaxation of a face", relaxation.to_string(), allowed));
                }
                let (mut low, mut high) = ([0; 3], self.cells);
                low[axis] = if side == 0 { 0 } else { self.cells[axis] - 1 };
                high[axis] = low[axis] + 1;
                let Some(profile) = face.profile() else { continue };
                for cell in cells_of([low, high]) {
                    let centre = Domain::of(self).centre(cell.map(|x| x as i64));
                    let velocity = (profile.0)(centre);
                    if !velocity.is_finite() {
                        let value = format!("{velocity:?} at {centre:?}");
                        return Err(SetupError::new("velocity of a face", value, "finite numbers"));
                    }
                }
            }
        }
        Ok(())
    }

    fn check_rates(&self) -> Result<(), SetupError> {
        let rates = match self.operator {
            Operator::MultipleRelaxation { ghosts, odd } => {
                let odd = match odd {
                    crate::OddRate::Rate(rate) => rate,
                    crate::OddRate::Magic(_) => 1.0,
                };
                vec![ghosts[0], ghosts[1], ghosts[2], odd]
            }
            _ => Vec::new(),
        };
        if let Some(rate) = rates.into_iter().find(|rate| !(*rate > 0.0 && *rate < 2.0)) {
            return Err(SetupError::new("relaxation rate", rate.to_string(), "between 0 and 2"));
        }
        let magic = self.operator.magic(self.tau());
        if !(magic > 0.0 && magic.is_finite()) {
            return Err(SetupError::new("Lambda", magic.to_string(), "above 0, such as 3/16"));
        }
        Ok(())
    }
}

/// Why a flow could not be set up.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetupError {
    /// What is wrong.
    pub what: String,
    /// The value found.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

impl SetupError {
    pub(crate) fn new(what: impl Into<String>, value: String, allowed: impl Into<String>) -> Self {
        Self { what: what.into(), value, allowed: allowed.into() }
    }
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}; allowed: {}", self.what, self.value, self.allowed)
    }
}

impl std::error::Error for SetupError {}

impl From<ShapeError> for SetupError {
    fn from(error: ShapeError) -> Self {
        let ShapeError { what, value, allowed } = error;
        Self { what, value, allowed }
    }
}
