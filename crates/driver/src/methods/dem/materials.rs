//! Materials of a scene of grains.

use super::{DemSpec, pairs, stiffness};
use crate::problems::{Problems, nearest, quoted};
use crate::scene::Scene;
use granular_dem::{MaterialId, Materials};
use std::collections::BTreeMap;

/// Materials of a scene, by name.
#[derive(Debug, Default)]
pub(super) struct NamedMaterials {
    pub(super) list: Materials,
    /// None for a material that was refused, so that its users are not blamed too.
    pub(super) ids: BTreeMap<String, Option<MaterialId>>,
}

impl NamedMaterials {
    pub(super) fn of(scene: &Scene, spec: &DemSpec, plane: bool, problems: &mut Problems) -> Self {
        let mut named = Self::default();
        let contact = spec.contact;
        for (name, &spec) in &scene.materials {
            if !stiffness::is_stated(&format!("materials.{}", quoted(name)), &spec, contact, plane, problems)
            {
                named.ids.insert(name.clone(), None);
                continue;
            }
            if spec.restitution.is_none() {
                let place = format!("materials.{}.restitution", quoted(name));
                problems.add(
                    place,
                    "missing",
                    "a number above 0 and at most 1",
                    "only walls of a continuum need none",
                );
                named.ids.insert(name.clone(), None);
                continue;
            }
            let added = named.list.add(spec.into()).map_err(|error| {
                let key = error.what.replace(' ', "_");
                problems.add(format!("materials.{}.{key}", quoted(name)), error.value, error.allowed, "");
            });
            named.ids.insert(name.clone(), added.ok());
        }
        pairs::state(&scene.pairs, contact, &mut named, problems);
        named
    }

    /// A material that there is.
    pub(super) fn id(&self, name: &str) -> Option<MaterialId> {
        self.ids.get(name).copied().flatten()
    }

    /// Normal stiffness of a material \[N/m\].
    pub(super) fn stiffness(&self, name: &str) -> f64 {
        self.id(name).map_or(0.0, |id| self.list.get(id).normal_stiffness)
    }

    pub(super) fn find(&self, path: &str, name: &str, problems: &mut Problems) -> Option<MaterialId> {
        let found = self.ids.get(name).copied();
        if found.is_none() {
            let known: Vec<&str> = self.ids.keys().map(String::as_str).collect();
            let hint = nearest(name, known.iter().copied());
            let allowed = format!("a material of this scene: {}", known.join(", "));
            problems.add(path, format!("`{name}`, which is not a material of this scene"), allowed, hint);
        }
        found.flatten()
    }
}

/// Materials of inlets by name, or what is wrong with them.
pub(super) fn inlet_materials(
    scene: &Scene,
    materials: &NamedMaterials,
    problems: &mut Problems,
) -> Vec<(String, MaterialId)> {
    let mut found = Vec::new();
    for (k, inlet) in scene.inlets.iter().enumerate() {
        let id = materials.find(&format!("inlets.{k}.material"), &inlet.material, problems);
        found.extend(id.map(|id| (inlet.material.clone(), id)));
    }
    found
}
