//! A sink that checks what it is shown.

use super::contract::{Breach, Contract};
use crate::field::{FieldRef, FieldSink, Location, Shown, ShownAs};
use crate::solver::Solver;
use std::collections::HashSet;

impl Contract {
    /// All that can be shown has a unique name and is shown exactly once, with its kind, its unit
    /// and one value per point, cell or link of its place, when everything is wanted and when it
    /// alone is wanted; what nobody wants is not shown. Places have names of their own, and the
    /// first is that of what the solver counts.
    ///
    /// # Errors
    /// When the promise is not kept.
    pub fn show(&self) -> Result<(), Breach> {
        const WHY: &str = "all that can be shown is shown once";
        let mut solver = (self.build)();
        for _ in 0..2 {
            let shown = solver.shown();
            let names: HashSet<&str> = shown.iter().map(|shown| shown.name.as_str()).collect();
            if names.len() < shown.len() || shown.is_empty() {
                return Err(Breach::new(WHY, "names are missing or not unique"));
            }
            let alone = shown.iter().map(std::slice::from_ref);
            for wanted in alone.chain([&shown[..], &[]]) {
                if let Some(found) = look(solver.as_ref(), wanted) {
                    return Err(Breach::new(WHY, found));
                }
            }
            self.go(solver.as_mut(), self.steps, WHY)?;
        }
        Ok(())
    }
}

/// Shows `wanted` and returns the first fault.
fn look(solver: &dyn Solver, wanted: &[Shown]) -> Option<String> {
    let items_of = |location| match location {
        Location::Points(points) => FieldRef::len(&points),
        Location::Grid { cells, .. } => cells.iter().product(),
    };
    let places = solver.places();
    let names: HashSet<&str> = places.iter().map(|(name, _)| *name).collect();
    if names.len() < places.len() || names.contains("") || places.is_empty() {
        return Some("names of places are missing or not unique".to_owned());
    }
    let items = items_of(places[0].1);
    if items != solver.size().0 {
        return Some(format!(
            "there are {} {}s, but {items} {}",
            solver.size().0,
            solver.size().1,
            places[0].0
        ));
    }
    let mut items = Vec::new();
    for shown in wanted {
        let Some(location) = solver.place(shown.place) else {
            return Some(format!(
                "`{}` lives at `{}`, which is no place of the solver",
                shown.name, shown.place
            ));
        };
        items.push(items_of(location));
    }
    let mut watch = Watch { wanted, items, seen: vec![0; wanted.len()], links: None, fault: None };
    solver.show(&mut watch);
    let missing = watch.seen.iter().position(|&count| count != 1);
    let missing =
        missing.map(|k| format!("`{}` was shown {} times instead of once", wanted[k].name, watch.seen[k]));
    watch.fault.or(missing)
}

/// Values that were shown, and how many links they belong to.
enum Length {
    None,
    Field(usize),
    Links(usize, usize),
}

struct Watch<'a> {
    wanted: &'a [Shown],
    /// How many points or cells there are where each lives.
    items: Vec<usize>,
    seen: Vec<u32>,
    links: Option<usize>,
    fault: Option<String>,
}

impl Watch<'_> {
    fn note(&mut self, fault: String) {
        self.fault.get_or_insert(fault);
    }

    fn take(&mut self, name: &str, unit: &str, kind: ShownAs, length: Length) {
        let Some(place) = self.wanted.iter().position(|shown| shown.name == name) else {
            return self.note(format!("`{name}` was shown although nobody wants it"));
        };
        self.seen[place] += 1;
        let shown = &self.wanted[place];
        if shown.kind != kind || shown.unit != unit {
            let found = format!("`{name}` was shown as {kind:?} in {unit}, not {shown:?}");
            return self.note(found);
        }
        let (found, expected) = match length {
            Length::None => return,
            Length::Field(found) => (found, self.items[place]),
            Length::Links(found, expected) => (found, expected),
        };
        if found != expected {
            self.note(format!("`{name}` has {found} values instead of {expected}"));
        }
    }
}

impl FieldSink for Watch<'_> {
    fn wants(&self, name: &str) -> bool {
        self.wanted.iter().any(|shown| shown.name == name)
    }

    fn field(&mut self, name: &str, unit: &str, values: FieldRef<'_>) {
        self.take(name, unit, ShownAs::Field, Length::Field(values.len()));
    }

    fn number(&mut self, name: &str, unit: &str, _: f64) {
        self.take(name, unit, ShownAs::Number, Length::None);
    }

    fn links(&mut self, pairs: &[[u32; 2]]) {
        if self.links.replace(pairs.len()).is_some() {
            self.note("links were shown twice".to_owned());
        }
        let first = self.wanted.iter().position(|shown| shown.kind == ShownAs::Link);
        let items = first.map_or(0, |first| self.items[first]);
        if let Some(pair) = pairs.iter().find(|pair| pair.iter().any(|&end| end as usize >= items)) {
            self.note(format!("the link {pair:?} has an end that does not exist"));
        }
    }

    fn link_field(&mut self, name: &str, unit: &str, values: FieldRef<'_>) {
        let Some(links) = self.links else {
            return self.note(format!("`{name}` was shown before its links"));
        };
        self.take(name, unit, ShownAs::Link, Length::Links(values.len(), links));
    }
}
