//! What a value measures, as powers of the base units.

/// What a value measures: powers of kg, m, s and rad, with the words for messages.
///
/// Two dimensions are equal when their powers are, whatever their names.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Dimension {
    /// Powers of kg, m, s and rad.
    pub powers: [i8; 4],
    /// What it is called, such as `length`.
    pub name: &'static str,
    /// SI unit, such as `m`; `1` for plain numbers.
    pub unit: &'static str,
    /// A value as a scene may write it, such as `1 mm`.
    pub example: &'static str,
}

impl PartialEq for Dimension {
    fn eq(&self, other: &Self) -> bool {
        self.powers == other.powers
    }
}

impl Eq for Dimension {}

macro_rules! dimensions {
    ($($constant:ident, $powers:expr, $name:literal, $unit:literal, $example:literal;)*) => {
        impl Dimension {
            $(
                #[doc = concat!("A ", $name, " \\[", $unit, "\\], such as `", $example, "`.")]
                pub const $constant: Self = Self::new($powers, $name, $unit, $example);
            )*
            /// Every dimension that has a name.
            pub const ALL: &'static [Self] = &[$(Self::$constant),*];
        }
    };
}

dimensions! {
    NUMBER, [0, 0, 0, 0], "plain number", "1", "0.5";
    LENGTH, [0, 1, 0, 0], "length", "m", "1 mm";
    AREA, [0, 2, 0, 0], "area", "m^2", "1 mm^2";
    VOLUME, [0, 3, 0, 0], "volume", "m^3", "1 cm^3";
    TIME, [0, 0, 1, 0], "time", "s", "10 ms";
    FREQUENCY, [0, 0, -1, 0], "frequency", "Hz", "50 Hz";
    ANGLE, [0, 0, 0, 1], "angle", "rad", "45 deg";
    ANGULAR_VELOCITY, [0, 0, -1, 1], "angular velocity", "rad/s", "3 rad/s";
    VELOCITY, [0, 1, -1, 0], "velocity", "m/s", "1 m/s";
    ACCELERATION, [0, 1, -2, 0], "acceleration", "m/s^2", "9.81 m/s^2";
    MASS, [1, 0, 0, 0], "mass", "kg", "1 g";
    DENSITY, [1, -3, 0, 0], "density", "kg/m^3", "2650 kg/m^3";
    FORCE, [1, 1, -2, 0], "force", "N", "1 N";
    STIFFNESS, [1, 0, -2, 0], "stiffness", "N/m", "1.6e6 N/m";
    DAMPING, [1, 0, -1, 0], "damping coefficient", "N s/m", "0.2 N s/m";
    PRESSURE, [1, -1, -2, 0], "pressure", "Pa", "70 GPa";
    ENERGY, [1, 2, -2, 0], "energy", "J", "1 mJ";
    POWER, [1, 2, -3, 0], "power", "W", "1 W";
    VISCOSITY, [1, -1, -1, 0], "viscosity", "Pa s", "1 mPa s";
    KINEMATIC_VISCOSITY, [0, 2, -1, 0], "kinematic viscosity", "m^2/s", "1e-6 m^2/s";
}

impl Dimension {
    /// A dimension of its own; the powers are those of kg, m, s and rad.
    pub const fn new(powers: [i8; 4], name: &'static str, unit: &'static str, example: &'static str) -> Self {
        Self { powers, name, unit, example }
    }

    /// Whether values are plain numbers.
    pub const fn is_number(&self) -> bool {
        matches!(self.powers, [0, 0, 0, 0])
    }

    /// The name with its article, such as `an angle`.
    pub fn with_article(&self) -> String {
        let vowel = self.name.starts_with(['a', 'e', 'i', 'o', 'u']);
        format!("{} {}", if vowel { "an" } else { "a" }, self.name)
    }

    /// The dimension with these powers that has a name.
    pub(super) fn named(powers: [i8; 4]) -> Option<Self> {
        Self::ALL.iter().find(|dimension| dimension.powers == powers).copied()
    }
}

/// Powers as text, such as `kg m^-3`.
pub(super) fn base_units(powers: [i8; 4]) -> String {
    let factors = powers.iter().zip(["kg", "m", "s", "rad"]).filter(|(power, _)| **power != 0);
    let words: Vec<String> = factors
        .map(|(power, base)| if *power == 1 { base.to_owned() } else { format!("{base}^{power}") })
        .collect();
    words.join(" ")
}
