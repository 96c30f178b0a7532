//! Reference data of the validation cases, as the text of CSV files, and what each case says of itself.
//!
//! Data live in a package of their own so that `cargo package` finds them. Each case has a folder
//! with a `README.md` that states source, set-up, tier of evidence and weakness.
//!
//! ```
//! let first = granular_validation_data::DISK_ON_INCLINE.lines().next().unwrap_or_default();
//! assert!(first.starts_with("friction_angle_deg,"));
//! ```

/// Angle turned by a disk on an incline of 45 degrees, over the friction angle.
pub const DISK_ON_INCLINE: &str = include_str!("../disk_on_incline/reference.csv");
/// Angle turned by a sphere on an incline of 45 degrees, over the friction angle.
pub const BALL_ON_INCLINE: &str = include_str!("../ball_on_incline/reference.csv");
/// Damping ratio, restitution and contact time of a linear spring-dashpot, for both treatments of
/// tension.
pub const RESTITUTION: &str = include_str!("../restitution/reference.csv");
/// The cumulative beta curve with both shape parameters 4.
pub const GRADING: &str = include_str!("../grading/reference.csv");
/// Run-out of columns of aspect ratio 0.8 in the literature.
pub const COLUMN_RUNOUT: &str = include_str!("../column_runout/reference.csv");
/// Run-out and height of columns over their aspect ratio in the thesis.
pub const COLUMN_STUDIES: &str = include_str!("../column_studies/reference.csv");
/// Run-out and energies of columns over time in the thesis.
pub const COLUMN_FLOW: &str = include_str!("../column_studies/flow.csv");
/// Run-out and densities of dense and loose columns in the thesis.
pub const COLUMN_DENSITY: &str = include_str!("../column_density/reference.csv");
/// Speed in a started channel over time and height.
pub const POISEUILLE: &str = include_str!("../poiseuille/reference.csv");
/// Speed between plates, one of which starts to move, over time and height.
pub const COUETTE: &str = include_str!("../couette/reference.csv");
/// Velocity along the lid on the vertical centre line of a cavity.
pub const CAVITY_U: &str = include_str!("../cavity/reference_u.csv");
/// Velocity across on the horizontal centre line of a cavity.
pub const CAVITY_V: &str = include_str!("../cavity/reference_v.csv");
/// Drag of a square array of disks over solid fraction.
pub const SQUARE_ARRAY: &str = include_str!("../square_array/reference.csv");
/// Coefficients of a cylinder in a channel.
pub const CYLINDER: &str = include_str!("../cylinder/reference.csv");
/// Closed form of impacts of elastic spheres.
pub const HERTZ_IMPACT: &str = include_str!("../hertz_impact/reference.csv");
/// Materials and speeds of the impacts of Chung and Ooi.
pub const CHUNG_OOI: &str = include_str!("../chung_ooi/reference.csv");
/// Packing density of a collapsing column.
pub const PACKING_DENSITY: &str = include_str!("../packing_density/reference.csv");
/// Numbers of weighted Voronoi diagrams with closed forms.
pub const TESSELLATION: &str = include_str!("../tessellation/reference.csv");
/// What the thesis says of piles that are pushed.
pub const SLOPE_IMPACT: &str = include_str!("../slope_impact/reference.csv");

/// What a case compares with, how, and what that is worth: its `README.md`.
pub fn readme(case: &str) -> Option<&'static str> {
    README.iter().find(|(name, _)| *name == case).map(|(_, text)| *text)
}

macro_rules! readmes {
    ($($case:ident)+) => {
        &[$((stringify!($case), include_str!(concat!("../", stringify!($case), "/README.md"))),)+]
    };
}

const README: &[(&str, &str)] = readmes! {
    ball_on_incline bouncing_ball carried_disk cavity chain_waves chung_ooi coarse_graining column_density
    column_runout column_studies contact_time couette critical_state cylinder disk_in_channel
    disk_on_incline elastic_column element_tests energy_balance flat_surface fluid_mass grading hertz_impact
    hydrostatic lattice_moduli momentum moving_walls oblique_impact packing_density periodic_cell poiseuille
    regular_packings restitution rotating_disk rotating_frame sample_densities single_point sliding_block
    sliding_to_rolling slope_impact square_array taylor_green tessellation two_disks uniform_drift
    vibrating_bar vortex_street wall_forces wall_in_channel womersley
};
