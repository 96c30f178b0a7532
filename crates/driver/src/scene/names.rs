//! Which names a scene uses: files of outputs, and what figures need of them.

use super::{FigureSpec, GridSpec, Writer};
use granular_tessellate::FREE_SURFACE;

/// What a figure draws from.
pub(crate) struct Need<'a> {
    /// Key under which the figure names its output.
    pub(crate) key: &'static str,
    /// Writer of that output.
    pub(crate) writer: &'static str,
    /// Path of the output.
    pub(crate) output: &'a str,
    /// What the output must hold.
    pub(crate) names: Vec<&'a str>,
    /// Stage from whose start the figure counts.
    pub(crate) stage: Option<&'a str>,
}

impl Writer {
    /// File, or files without their ending, in the run folder.
    pub fn path(&self) -> &str {
        match self {
            Self::Table { path, .. }
            | Self::Fields { path, .. }
            | Self::Contacts { path, .. }
            | Self::Profile { path, .. }
            | Self::Tracks { path, .. }
            | Self::Hdf5 { path, .. } => path,
        }
    }

    /// Name of this kind of writer.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Table { .. } => "Table",
            Self::Fields { .. } => "Fields",
            Self::Contacts { .. } => "Contacts",
            Self::Profile { .. } => "Profile",
            Self::Tracks { .. } => "Tracks",
            Self::Hdf5 { .. } => "Hdf5",
        }
    }

    /// Probes or fields.
    pub fn names(&self) -> &[String] {
        match self {
            Self::Table { probes: names, .. }
            | Self::Fields { fields: names, .. }
            | Self::Contacts { fields: names, .. }
            | Self::Profile { fields: names, .. }
            | Self::Tracks { fields: names, .. }
            | Self::Hdf5 { fields: names, .. } => names,
        }
    }

    /// Voronoi cells larger than this many times the mean are free surface.
    pub(crate) fn free_surface(&self) -> f64 {
        match self {
            Self::Table { free_surface, .. } | Self::Fields { free_surface, .. } => *free_surface,
            _ => FREE_SURFACE,
        }
    }

    /// Cells over which grains are averaged, if they are.
    pub(crate) fn grid(&self) -> Option<&GridSpec> {
        match self {
            Self::Fields { grid, .. } | Self::Profile { grid, .. } | Self::Hdf5 { grid, .. } => grid.as_ref(),
            Self::Table { .. } | Self::Contacts { .. } | Self::Tracks { .. } => None,
        }
    }
}

impl FigureSpec {
    /// Name of the figure, without ending.
    pub fn path(&self) -> &str {
        match self {
            Self::Series { path, .. }
            | Self::Curve { path, .. }
            | Self::Runout { path, .. }
            | Self::RadialProfile { path, .. }
            | Self::Energies { path, .. }
            | Self::Flow { path, .. }
            | Self::Cells { path, .. }
            | Self::ForceChains { path, .. }
            | Self::Map { path, .. }
            | Self::Profile { path, .. }
            | Self::Impact { path, .. }
            | Self::Spectrum { path, .. } => path,
        }
    }

    /// Times that the figure shows; none of one that shows all.
    pub(crate) fn times(&self) -> &[f64] {
        match self {
            Self::RadialProfile { times, .. }
            | Self::Flow { times, .. }
            | Self::Cells { times, .. }
            | Self::Map { times, .. }
            | Self::Profile { times, .. } => times,
            Self::ForceChains { time, .. } => std::slice::from_ref(time),
            _ => &[],
        }
    }

    /// Whether its times are in units of sqrt(H/g) where a column spreads.
    pub(crate) fn is_scaled(&self) -> bool {
        !matches!(self, Self::Map { .. } | Self::Profile { .. })
    }

    /// What a figure needs; `front` is the number that says how far the sample spread.
    pub(crate) fn needs(&self, front: &'static str) -> Need<'_> {
        match self {
            Self::Series { table, columns, stage, .. } => {
                let names = columns.iter().map(String::as_str).collect();
                Need { key: "table", writer: "Table", output: table, names, stage: stage.as_deref() }
            }
            Self::Curve { table, x, columns, stage, .. } => {
                let mut names: Vec<&str> = columns.iter().map(String::as_str).collect();
                // Time is in every table.
                names.extend(Some(x.as_str()).filter(|x| *x != "time"));
                Need { key: "table", writer: "Table", output: table, names, stage: stage.as_deref() }
            }
            Self::Runout { table, stage, .. } => Need {
                key: "table",
                writer: "Table",
                output: table,
                names: vec![front, "height"],
                stage: Some(stage),
            },
            Self::Energies { table, stage, .. } => Need {
                key: "table",
                writer: "Table",
                output: table,
                // And what else the solver says.
                names: vec!["potential_energy", "kinetic_energy"],
                stage: Some(stage),
            },
            Self::Flow { fields, color, stage, .. } => Need {
                key: "fields",
                writer: "Fields",
                output: fields,
                names: vec!["radius", color],
                stage: Some(stage),
            },
            Self::RadialProfile { fields, stage, .. } => Need {
                key: "fields",
                writer: "Fields",
                output: fields,
                names: vec!["radius"],
                stage: Some(stage),
            },
            Self::Cells { fields, stage, .. } => Need {
                key: "fields",
                writer: "Fields",
                output: fields,
                names: vec!["radius", "local_density", "in_bulk"],
                stage: Some(stage),
            },
            Self::ForceChains { contacts, stage, .. } => Need {
                key: "contacts",
                writer: "Contacts",
                output: contacts,
                names: vec!["normal_force"],
                stage: Some(stage),
            },
            Self::Map { fields, color, stage, .. } => Need {
                key: "fields",
                writer: "Fields",
                output: fields,
                names: vec![color],
                stage: Some(stage),
            },
            Self::Profile { profile, column, stage, .. } => Need {
                key: "profile",
                writer: "Profile",
                output: profile,
                names: vec![field_of(column)],
                stage: Some(stage),
            },
            Self::Impact { table, stage, .. } => Need {
                key: "table",
                writer: "Table",
                output: table,
                names: vec!["front", "kinetic_energy", "kinetic_energy_x"],
                stage: Some(stage),
            },
            Self::Spectrum { table, column, stage, .. } => {
                Need { key: "table", writer: "Table", output: table, names: vec![column], stage: Some(stage) }
            }
        }
    }
}

impl FigureSpec {
    /// What a figure needs of a second output.
    pub(crate) fn also_needs(&self) -> Option<Need<'_>> {
        let Self::Map { grains: Some(grains), .. } = self else { return None };
        Some(Need { key: "grains", writer: "Fields", output: grains, names: vec!["radius"], stage: None })
    }
}

/// The field of which a column of a profile is a component: `velocity` of `velocity_x`.
fn field_of(column: &str) -> &str {
    ["_x", "_y", "_z"].iter().find_map(|end| column.strip_suffix(end)).unwrap_or(column)
}

/// Energies of grains, for the figure of them.
pub const ENERGIES: &[&str] = &[
    "potential_energy",
    "kinetic_energy",
    "rotational_energy",
    "contact_energy",
    "loss_sliding",
    "loss_sliding_at_walls",
    "loss_normal_damping",
    "loss_tangential_damping",
    "loss_rolling",
    "energy_residual",
];
