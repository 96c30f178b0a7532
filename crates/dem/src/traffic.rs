//! Grains that come and go while a simulation runs.
//!
//! Both happen between steps, at fixed counts of steps, so that a split or a restart changes nothing. Places and
//! sizes are drawn from the seed and the number of the grain, never from a stream: there is no random state.

use crate::dem::Dem;
use crate::grains::{Grain, check, check_finite, check_sizes};
use crate::material::{MaterialId, SetupError};
use granular_core::{Dim, Linear, Section, SnapshotError, Vector};
use room::{Ball, Room};

mod room;

/// Steps between two looks at what inlets and outlets have to do.
pub const STEPS_PER_LOOK: u64 = 100;
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

/// A place where grains are put in, at a rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Inlet<D: Dim> {
    /// Name.
    pub name: String,
    /// Lower corner of the box in which whole grains are placed \[m\].
    pub low: D::Vec,
    /// Upper corner \[m\].
    pub high: D::Vec,
    /// Grains per time \[1/s\].
    pub rate: f64,
    /// Grains in all, those that do not fit included.
    pub number: u64,
    /// Radii, each as likely as any other \[m\].
    pub radii: Vec<f64>,
    /// Velocity at which they come \[m/s\].
    pub velocity: D::Vec,
    /// Material.
    pub material: MaterialId,
    /// Random seed.
    pub seed: u64,
    /// Whether it runs from the start.
    pub runs: bool,
}

/// Where grains are taken out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outlet<D: Dim> {
    /// Where the centre is beyond a plane, on the side to which the normal points.
    Beyond {
        /// A point of the plane \[m\].
        point: D::Vec,
        /// Normal, of any length.
        normal: D::Vec,
    },
    /// Where the centre is outside a box.
    Outside {
        /// Lower corner \[m\].
        low: D::Vec,
        /// Upper corner \[m\].
        high: D::Vec,
    },
}

impl<D: Dim> Outlet<D> {
    fn takes(&self, at: D::Vec) -> bool {
        match *self {
            Self::Beyond { point, normal } => (at - point).dot(normal) > 0.0,
            Self::Outside { low, high } => at.max(low).min(high) != at,
        }
    }
}

/// Grains that came and went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchanged {
    /// Grains put in.
    pub inserted: u64,
    /// Grains that were due but did not fit in.
    pub not_placed: u64,
    /// Grains taken out.
    pub removed: u64,
    /// Mass put in \[kg; kg/m in the plane\].
    pub mass_inserted: f64,
    /// Mass taken out \[kg; kg/m in the plane\].
    pub mass_removed: f64,
    /// Energy that came with grains, less what left with them \[J\]; zero unless the ledger is kept.
    pub energy: f64,
}

/// An inlet and what it has done.
#[derive(Clone, Debug)]
struct Source<D: Dim> {
    inlet: Inlet<D>,
    /// Time for which it ran before it was last started \[s\].
    before: f64,
    /// When it was last started \[s\]; not a number while it does not run.
    since: f64,
    /// Grains that were due so far.
    tried: u64,
}

impl<D: Dim> Source<D> {
    fn elapsed(&self, time: f64) -> f64 {
        if self.since.is_nan() { self.before } else { self.before + (time - self.since) }
    }

    /// Grains that are due now.
    fn due(&self, time: f64) -> u64 {
        let all = (self.inlet.rate * self.elapsed(time)).floor() as u64;
        all.min(self.inlet.number).saturating_sub(self.tried)
    }
}

/// Where grains come and go; nothing in most scenes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Traffic<D: Dim> {
    sources: Vec<Source<D>>,
    outlets: Vec<Outlet<D>>,
    next_id: u32,
    done: Exchanged,
}

impl<D: Dim> Traffic<D> {
    pub(crate) fn new(grains: usize) -> Self {
        Self { sources: Vec::new(), outlets: Vec::new(), next_id: grains as u32, done: Exchanged::default() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.sources.is_empty() && self.outlets.is_empty()
    }

    /// Whether an inlet has grains left, now or when it is started.
    pub(crate) fn brings_grains(&self) -> bool {
        self.sources.iter().any(|source| source.tried < source.inlet.number)
    }

    /// Inlets and outlets.
    pub(crate) fn doors(&self) -> usize {
        self.sources.len() + self.outlets.len()
    }

    pub(crate) fn has_outlets(&self) -> bool {
        !self.outlets.is_empty()
    }

    pub(crate) fn inlets(&self) -> impl Iterator<Item = &Inlet<D>> {
        self.sources.iter().map(|source| &source.inlet)
    }

    pub(crate) fn save(&self, to: &mut Section) {
        if self.is_empty() {
            return;
        }
        let clocks: Vec<[f64; 3]> = self
            .sources
            .iter()
            .map(|source| {
                let runs = !source.since.is_nan();
                [f64::from(u8::from(runs)), source.before, if runs { source.since } else { 0.0 }]
            })
            .collect();
        let tried: Vec<u64> = self.sources.iter().map(|source| source.tried).collect();
        let Exchanged { inserted, not_placed, removed, mass_inserted, mass_removed, energy } = self.done;
        to.put("clocks of inlets", &clocks);
        to.put("grains due", &tried);
        to.put_one("next identifier", self.next_id);
        to.put("grains exchanged", &[inserted, not_placed, removed]);
        to.put("mass and energy exchanged", &[mass_inserted, mass_removed, energy]);
    }

    pub(crate) fn restore(&mut self, from: &Section) -> Result<(), SnapshotError> {
        if self.is_empty() {
            return Ok(());
        }
        let clocks: Vec<[f64; 3]> = from.array_of("clocks of inlets", self.sources.len())?;
        check_finite("clocks of inlets", clocks.iter().flatten().all(|value| value.is_finite()))?;
        let tried: Vec<u64> = from.array_of("grains due", self.sources.len())?;
        for ((source, [runs, before, since]), tried) in self.sources.iter_mut().zip(clocks).zip(tried) {
            (source.before, source.tried) = (before, tried);
            source.since = if runs == 0.0 { f64::NAN } else { since };
        }
        self.next_id = from.one("next identifier")?;
        let counts: Vec<u64> = from.array_of("grains exchanged", 3)?;
        let sums: Vec<f64> = from.array_of("mass and energy exchanged", 3)?;
        check_finite("mass and energy exchanged", sums.iter().all(|sum| sum.is_finite()))?;
        self.done = Exchanged {
            inserted: counts[0],
            not_placed: counts[1],
            removed: counts[2],
            mass_inserted: sums[0],
            mass_removed: sums[1],
            energy: sums[2],
        };
        Ok(())
    }
}

/// A number in [0, 1) for a seed and the place in a table of numbers (splitmix64).
fn uniform(seed: u64, grain: u64, draw: u64) -> f64 {
    let mix = |z: u64| {
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let golden = 0x9e37_79b9_7f4a_7c15_u64;
    let bits =
        mix(mix(mix(seed.wrapping_add(golden)).wrapping_add(grain))
            .wrapping_add(golden.wrapping_mul(draw + 1)));
    (bits >> 11) as f64 * 2.0_f64.powi(-53)
}

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
        self.grains.expect_material(*material);
        let since = if *runs { self.time() } else { f64::NAN };
        self.traffic.sources.push(Source { inlet, before: 0.0, since, tried: 0 });
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
        self.traffic.outlets.push(outlet);
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
        for source in self.traffic.sources.iter_mut().filter(|source| source.inlet.name == name) {
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
        self.traffic.done
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
        !self.traffic.is_empty() && (self.steps + steps).is_multiple_of(STEPS_PER_LOOK)
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
            self.traffic.done.energy += gain;
        }
    }

    /// Whether any grain is to go, and takes them out when told to.
    fn remove(&mut self, really: bool) -> bool {
        let outlets = &self.traffic.outlets;
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
                self.traffic.done.removed += 1;
                self.traffic.done.mass_removed += self.grains.mass[index];
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
            return self.traffic.sources.iter().any(|source| source.due(time) > 0);
        }
        let place: Vec<u32> = (0..self.len() as u32).collect();
        for index in 0..self.traffic.sources.len() {
            let source = &self.traffic.sources[index];
            let (first, due) = (source.tried, source.due(time));
            let inlet = source.inlet.clone();
            self.traffic.sources[index].tried += due;
            let mut near = Room::of(&inlet, self.near(&inlet));
            for number in first..first + due {
                match self.fit(&inlet, number, &near) {
                    Some(grain) if self.traffic.next_id < u32::MAX => {
                        near.add(grain.position, grain.radius);
                        self.put_in(&grain);
                    }
                    _ => self.traffic.done.not_placed += 1,
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
        let pick = uniform(inlet.seed, number, 0) * inlet.radii.len() as f64;
        let radius = inlet.radii[(pick as usize).min(inlet.radii.len() - 1)];
        (0..TRIES).find_map(|attempt| {
            let coordinate = |axis: usize| {
                let (low, high) = (inlet.low.component(axis), inlet.high.component(axis));
                let share = uniform(inlet.seed, number, 1 + attempt * D::N as u64 + axis as u64);
                low + radius + share * (high - low - 2.0 * radius)
            };
            let at = (0..D::N).fold(D::Vec::ZERO, |at, axis| at + D::Vec::along(axis, coordinate(axis)));
            let of_grains = near.has_place(at, radius);
            let of_walls = self.walls.iter().enumerate().filter(|(_, wall)| !wall.open).all(|(k, wall)| {
                let point = self.movers.poses.get(k).map_or(at, |pose| pose.within_wall(at));
                wall.shape.distance(point).0 >= radius
            });
            (of_grains && of_walls).then(|| Grain::at(at, radius, inlet.material).moving(inlet.velocity))
        })
    }

    fn put_in(&mut self, grain: &Grain<D>) {
        let mass = self.materials.get(grain.material).density * D::ball_volume(grain.radius);
        let turns = self.pairs.tangential();
        self.grains.push(grain, (self.traffic.next_id, mass, self.gravity), turns);
        self.traffic.next_id += 1;
        self.traffic.done.inserted += 1;
        self.traffic.done.mass_inserted += mass;
    }

    pub(crate) fn traffic_numbers(
        &self,
    ) -> impl Iterator<Item = ((&'static str, &'static str, &'static str), f64)> {
        let Exchanged { inserted, not_placed, removed, mass_inserted, mass_removed, energy } =
            self.traffic.done;
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
        let shown = if self.traffic.is_empty() { 0 } else { NUMBERS.len() };
        NUMBERS.into_iter().zip(values).take(shown)
    }
}
