//! The material that is tested: from a file of its own, or from a scene.

use super::{Element, Plan};
use crate::failure::Failure;
use crate::methods::mpm::ContinuumSpec;
use crate::methods::mpm::materials::law;
use crate::problems::{Problems, nearest, quoted};
use crate::scene::Scene;
use crate::scene_file::{SceneProblem, SceneText};
use granular_constitutive::AnyLaw;
use granular_constitutive::spec::ConstitutiveLawSpec;
use std::path::Path;

/// A material as a continuum, under the name that a scene or a file gives it.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name.
    pub name: String,
    law: AnyLaw,
}

impl Material {
    /// Reads a file with what stands behind a name in `continua`, such as `(density: .., law: MohrCoulomb(..))`, or a continuum
    /// of a scene, as `scene.ron:sand`; then makes the assignments, which are those of [`SceneText::set`].
    ///
    /// # Errors
    /// When there is no such file or name, or a value is wrong; the error says where it stands and what is allowed.
    pub fn read(source: &str, assignments: &[String]) -> Result<Self, Failure> {
        let (path, name) = split(source);
        let mut text = SceneText::read(path)?;
        assignments.iter().try_for_each(|assignment| text.set(assignment))?;
        match name {
            Some(name) => Self::of_scene(name, &text),
            None => Self::of_text(&stem(path), &text),
        }
    }

    /// The continuum of a scene that has this name.
    ///
    /// # Errors
    /// When the scene has none of this name, or a value is wrong.
    pub fn of_scene(name: &str, text: &SceneText) -> Result<Self, Failure> {
        let scene: Scene = text.parse()?;
        let Some(spec) = scene.continua.get(name) else {
            let known: Vec<&str> = scene.continua.keys().map(String::as_str).collect();
            let hint = nearest(name, known.iter().copied());
            let allowed = match known.as_slice() {
                [] => "a scene with `continua`; this one has none".to_owned(),
                _ => format!("one of them: {}", known.join(", ")),
            };
            let problem = SceneProblem::at_path("continua", format!("without `{name}`"), allowed, hint);
            return Err(problem.located_in(text).into());
        };
        Self::of_spec(name, spec, &format!("continua.{}.", quoted(name)), text)
    }

    /// A file that holds one material.
    ///
    /// # Errors
    /// When a value is wrong, or the text is that of a scene.
    pub fn of_text(name: &str, text: &SceneText) -> Result<Self, Failure> {
        if text.locate("continua").is_some() {
            let message = "this is a scene, and which of its continua is meant is not said";
            let hint = format!("put its name behind the file, such as `{}:sand`", text.name());
            return Err(SceneProblem::of_file(text.name(), message).with_hint(hint).into());
        }
        let spec: ContinuumSpec = text.parse()?;
        Self::of_spec(name, &spec, "", text)
    }

    /// `place`: what stands in front of its keys in a path of the text.
    fn of_spec(name: &str, spec: &ContinuumSpec, place: &str, text: &SceneText) -> Result<Self, Failure> {
        let mut problems = Problems::default();
        let given = spec.density.map(|density| density.value());
        let folder = Path::new(text.name()).parent().unwrap_or(Path::new(""));
        let Some(spec_of_law) = spec.law((folder, None), place, &mut problems) else {
            return Err(Failure::Scene(SceneProblem::all_located_in(problems.0, text)));
        };
        let is_fluid = matches!(
            spec_of_law,
            ConstitutiveLawSpec::Newtonian { .. } | ConstitutiveLawSpec::Bingham { .. }
        );
        let density = match given {
            // Any will do: it is not used.
            None if !is_fluid => Some(1.0),
            Some(density) if density > 0.0 => Some(density),
            other => {
                let value = other.map_or("missing".to_owned(), |density| density.to_string());
                let hint = "the pressure of a fluid follows from its density";
                problems.add(format!("{place}density"), value, "a positive density", hint);
                None
            }
        };
        let law =
            density.and_then(|density| law(&spec_of_law, density, &format!("{place}law"), &mut problems));
        law.map(|law| Self { name: name.to_owned(), law })
            .ok_or_else(|| Failure::Scene(SceneProblem::all_located_in(problems.0, text)))
    }

    /// Name of its law.
    pub const fn law(&self) -> &'static str {
        self.law.name()
    }

    /// Leads the material along a path.
    ///
    /// # Errors
    /// When a value of the plan is out of range, a stress cannot be reached, or the stress is not finite.
    pub fn test(&self, plan: Plan) -> Result<Element, Failure> {
        plan.check()?;
        let test = self.law.run(&plan.path()).map_err(|error| Failure::Stopped {
            reason: format!("{}, {} of `{}`: {error}", plan.test.name(), self.law(), self.name),
            hint: "a smaller --strain, more --steps or another --pressure stay within what the law can do"
                .to_owned(),
        })?;
        Ok(Element { material: self.name.clone(), law: self.law(), plan, test })
    }
}

/// The file and, behind a colon, the name of a continuum. A file whose own name has a colon is one.
fn split(source: &str) -> (&Path, Option<&str>) {
    let whole = Path::new(source);
    match source.rsplit_once(':') {
        Some((file, name)) if !file.is_empty() && !name.is_empty() && !whole.exists() => {
            (Path::new(file), Some(name))
        }
        _ => (whole, None),
    }
}

fn stem(path: &Path) -> String {
    match path.file_stem().map(|stem| stem.to_string_lossy().into_owned()) {
        Some(stem) if stem != "-" => stem,
        _ => "material".to_owned(),
    }
}
