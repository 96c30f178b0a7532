//! What inlets and outlets do to a solver.

use super::room::{Ball, Room};
use super::{Exchanged, Inlet, Outlet, STEPS_PER_LOOK, Source};
use crate::dem::Dem;
use crate::grains::{Grain, check, check_sizes};
use crate::material::SetupError;
use granular_core::random::uniform_at;
use granular_core::{Dim, Linear, Vector};

/// Places tried for one grain.
const TRIES: u64 = 100;
/// Shown numbers.
const NUMBERS: [(&str, &str, &str); 7] = [
    ("grains", "1", "number of grains"),
    ("inserted", "1", "grains put in since the start"),
    ("not_placed", "1", "grains that were due but did not fit in"),
    ("removed", "1", "grains taken out since the start"),
    ("mass_inserted", "kg", "mass put in since the start"),
    ("mass_removed", "kg", "mass taken out since the start"),
    ("energy_exchanged", "J", "energy that came with grains, less what left with them; with the ledger only"),
];

impl<D: Dim> Dem<D> {
    /// Lets grains come in from now on, at every hundredth step.
    ///
    /// # Errors
    /// When a value is out of range, or the largest grain does not fit into the box.
    pub fn add_inlet(&mut self, inlet: Inlet<D>) -> Result<(), SetupError> {
        self.check_inlet(&inlet)?;
        self.refuse_cell()?;
        let Inlet { radii, material, runs, .. } = &inlet;
        if self.is_empty() {
            self.use_skin_of(2.0 * radii.iter().sum::<f64>() / radii.len() as f64);
        }
        self.unchecked = true;
        self.grains.expect_material(*material);
        let since = if *runs { self.time() } else { f64::NAN };
        self.inlets.sources.push(Source { inlet, before: 0.0, since, tried: 0 });
        Ok(())
    }

    /// Takes grains out from now on, looking at every hundredth step.
    ///
    /// # Errors
    /// When a corner is not finite or a plane has no direction.
    pub fn add_outlet(&mut self, outlet: Outlet<D>) -> Result<(), SetupError> {
        let fits = match outlet {
            Outlet::Beyond { point, normal } => {
                point.is_finite() && normal.is_finite() && normal.length() > 0.0
            }
            Outlet::Outside { low, high } => low.is_finite() && high.is_finite() && low.max(high) == high,
        };
        if !fits {
            return Err(SetupError::new(
                "plane or box of an outlet",
                f64::NAN,
                "finite, with a direction or extent",
            ));
        }
        self.refuse_cell()?;
        self.inlets.outlets.push(outlet);
        Ok(())
    }

    /// A periodic cell holds as many grains as it began with.
    fn refuse_cell(&self) -> Result<(), SetupError> {
        match self.cell() {
            Some(_) => Err(SetupError::new("number of inlets and outlets with a periodic cell", 1.0, "0")),
            None => Ok(()),
        }
    }

    /// Starts or stops an inlet. Returns whether there is one of this name.
    pub fn set_inlet(&mut self, name: &str, runs: bool) -> bool {
        let time = self.time();
        let mut found = false;
        for source in self.inlets.sources.iter_mut().filter(|source| source.inlet.name == name) {
            found = true;
            if runs == source.since.is_nan() {
                source.before = source.elapsed(time);
                source.since = if runs { time } else { f64::NAN };
            }
        }
        found
    }

    /// Grains that came and went since the start.
    pub fn exchanged(&self) -> Exchanged {
        self.inlets.done
    }

    fn check_inlet(&self, inlet: &Inlet<D>) -> Result<(), SetupError> {
        let refuse = |what: &str, value: f64, allowed| {
            Err(SetupError::new(format!("{what} of inlet `{}`", inlet.name), value, allowed))
        };
        let largest = inlet.radii.iter().fold(0.0, |a: f64, &b| a.max(b));
        let room =
            (0..D::N).map(|axis| (inlet.high - inlet.low).component(axis)).fold(f64::INFINITY, f64::min);
        if let Some(radius) = inlet.radii.iter().find(|radius| !(radius.is_finite() && **radius > 0.0)) {
            return refuse("radius", *radius, "positive and finite");
        }
        if inlet.radii.is_empty() {
            return refuse("number of radii", 0.0, "at least one");
        }
        check_sizes(inlet.radii.iter().chain(&self.grains.radius).copied())?;
        if !(room >= 2.0 * largest && inlet.low.is_finite() && inlet.high.is_finite()) {
            return refuse("extent", room, "at least the diameter of the largest grain");
        }
        if !(inlet.rate.is_finite() && inlet.rate > 0.0) {
            return refuse("rate", inlet.rate, "positive and finite");
        }
        if !inlet.velocity.is_finite() {
            return refuse("velocity", f64::NAN, "finite");
        }
        if inlet.material.0 as usize >= self.materials.len() {
            return refuse("material", f64::from(inlet.material.0), "one of the materials of this set-up");
        }
        for &radius in &inlet.radii {
            check(&Grain::<D>::at(inlet.low, radius, inlet.material), &self.materials)?;
        }
        Ok(())
    }

    /// Whether a look is due when so many more steps are taken.
    pub(crate) fn looks_after(&self, steps: u64) -> bool {
        !self.inlets.is_empty() && (self.steps + steps).is_multiple_of(STEPS_PER_LOOK)
    }

    /// Lets grains come and go when the count of steps says so.
    pub(crate) fn exchange_if_due(&mut self) {
        if !self.looks_after(0) {
            return;
        }
        self.book(Self::remove);
        self.book(Self::insert);
    }

    /// Makes a change and books the energy it brings. The energies are looked at only if something is due.
    fn book(&mut self, change: fn(&mut Self, bool) -> bool) {
        if !change(self, false) {
            return;
        }
        let before = self.options.ledger.then(|| self.energies().mechanical());
        change(self, true);
        if let Some(before) = before {
            let gain = self.energies().mechanical() - before;
            self.injected += gain;
            self.inlets.done.energy += gain;
        }
    }

    /// Whether any grain is to go, and takes them out when told to.
    fn remove(&mut self, really: bool) -> bool {
        let outlets = &self.inlets.outlets;
        let goes = |at: D::Vec| outlets.iter().any(|outlet| outlet.takes(at));
        if !really {
            return self.grains.position.iter().any(|&at| goes(at));
        }
        let stays: Vec<bool> = self.grains.position.iter().map(|&at| !goes(at)).collect();
        let mut place = vec![u32::MAX; stays.len()];
        let mut kept = 0;
        for (index, &stays) in stays.iter().enumerate() {
            if stays {
                place[index] = kept;
                kept += 1;
            } else {
                self.inlets.done.removed += 1;
                self.inlets.done.mass_removed += self.grains.mass[index];
            }
        }
        self.grains.retain(&stays);
        self.regroup(&place);
        true
    }

    /// Whether any grain is due, and puts in what fits when told to.
    fn insert(&mut self, really: bool) -> bool {
        let time = self.time();
        if !really {
            return self.inlets.sources.iter().any(|source| source.due(time) > 0);
        }
        let place: Vec<u32> = (0..self.len() as u32).collect();
        for index in 0..self.inlets.sources.len() {
            let source = &self.inlets.sources[index];
            let (first, due) = (source.tried, source.due(time));
            let inlet = source.inlet.clone();
            self.inlets.sources[index].tried += due;
            let mut near = Room::of(&inlet, self.near(&inlet));
            for number in first..first + due {
                match self.fit(&inlet, number, &near) {
                    Some(grain) if self.inlets.next_id < u32::MAX => {
                        near.add(grain.position, grain.radius);
                        self.put_in(&grain);
                    }
                    _ => self.inlets.done.not_placed += 1,
                }
            }
        }
        self.regroup(&place);
        true
    }

    /// Grains that can be in the way at an inlet.
    fn near(&self, inlet: &Inlet<D>) -> Vec<Ball<D>> {
        let grains = self.grains.position.iter().copied().zip(self.grains.radius.iter().copied());
        let reaches = |&(at, radius): &Ball<D>| {
            (at - at.max(inlet.low).min(inlet.high)).length_squared() < radius * radius
        };
        grains.filter(reaches).collect()
    }

    /// The grain of a number where it fits in, if it does.
    fn fit(&self, inlet: &Inlet<D>, number: u64, near: &Room<D>) -> Option<Grain<D>> {
        let pick = uniform_at(inlet.seed, number, 0) * inlet.radii.len() as f64;
        let radius = inlet.radii[(pick as usize).min(inlet.radii.len() - 1)];
        (0..TRIES).find_map(|attempt| {
            let coordinate = |axis: usize| {
                let (low, high) = (inlet.low.component(axis), inlet.high.component(axis));
                let share = uniform_at(inlet.seed, number, 1 + attempt * D::N as u64 + axis as u64);
                low + radius + share * (high - low - 2.0 * radius)
            };
            let at = (0..D::N).fold(D::Vec::ZERO, |at, axis| at + D::Vec::along(axis, coordinate(axis)));
            let of_grains = near.has_place(at, radius);
            let of_walls = self.walls.iter().enumerate().filter(|(_, wall)| !wall.open).all(|(k, wall)| {
                let point = self.moving_walls.poses.get(k).map_or(at, |pose| pose.within_wall(at));
                wall.shape.distance(point).0 >= radius
            });
            (of_grains && of_walls).then(|| Grain::at(at, radius, inlet.material).moving(inlet.velocity))
        })
    }

    fn put_in(&mut self, grain: &Grain<D>) {
        let mass = self.materials.get(grain.material).density * D::ball_volume(grain.radius);
        self.grains.push(grain, (self.inlets.next_id, mass, self.gravity));
        self.inlets.next_id += 1;
        self.inlets.done.inserted += 1;
        self.inlets.done.mass_inserted += mass;
    }

    pub(crate) fn exchange_numbers(
        &self,
    ) -> impl Iterator<Item = ((&'static str, &'static str, &'static str), f64)> {
        let Exchanged { inserted, not_placed, removed, mass_inserted, mass_removed, energy } =
            self.inlets.done;
        let count = |number: u64| number as f64;
        let values = [
            self.len() as f64,
            count(inserted),
            count(not_placed),
            count(removed),
            mass_inserted,
            mass_removed,
            energy,
        ];
        let shown = if self.inlets.is_empty() { 0 } else { NUMBERS.len() };
        NUMBERS.into_iter().zip(values).take(shown)
    }
}
