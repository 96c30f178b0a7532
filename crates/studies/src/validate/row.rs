//! Rows of a validation, and how they are measured.

use serde::Serialize;
use std::time::Instant;

/// The evidence behind a reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tier {
    /// An exact solution.
    ClosedForm,
    /// The order of convergence.
    Order,
    /// A conserved quantity.
    Conservation,
    /// Something that holds by definition.
    Identity,
    /// An experiment.
    Experiment,
    /// Another code.
    OtherCode,
    /// A figure or number of \[Kumar2014\].
    Thesis,
}

impl Tier {
    /// What people call it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed form",
            Self::Order => "order of convergence",
            Self::Conservation => "conservation",
            Self::Identity => "identity",
            Self::Experiment => "experiment",
            Self::OtherCode => "other code",
            Self::Thesis => "thesis",
        }
    }
}

/// One measured number beside its reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Case.
    pub case: &'static str,
    /// Solver, or what else was measured.
    pub solver: &'static str,
    /// Evidence.
    pub tier: Tier,
    /// What was measured, with its unit.
    pub metric: String,
    /// The measured value.
    pub value: f64,
    /// What it should be.
    pub reference: f64,
    /// Distance from the reference, as compared with the tolerance: relative unless the note says
    /// otherwise.
    pub error: f64,
    /// Largest error that passes.
    pub tolerance: f64,
    /// Whether it passes.
    pub pass: bool,
    /// Whether a failure makes the validation fail.
    pub gate: bool,
    /// Whether it is judged: a claim is not where fewer grains were run than it takes to bear it.
    pub judged: bool,
    /// Wall time spent on it \[s\].
    pub seconds: f64,
    /// What else there is to know.
    pub note: String,
}

impl Row {
    /// What there is to know but whether the error is absolute, and that.
    pub(super) fn remark(&self) -> (&str, bool) {
        match self.note.strip_prefix(ABSOLUTE) {
            Some(rest) => (rest.trim_start_matches("; "), true),
            None => (&self.note, false),
        }
    }

    /// What became of it, in a word.
    pub(super) fn verdict(&self) -> &'static str {
        match (self.gate, self.pass) {
            _ if !self.judged => "small",
            (true, true) => "pass",
            (true, false) => "FAILED",
            (false, true) => "met",
            (false, false) => "differs",
        }
    }
}

/// What notes say of errors that are not over their reference.
const ABSOLUTE: &str = "absolute error";

/// A measurement before it is a row.
#[derive(Clone, Debug)]
pub(crate) struct Measure {
    tier: Tier,
    metric: String,
    value: f64,
    reference: f64,
    error: f64,
    tolerance: f64,
    gate: bool,
    note: String,
}

impl Measure {
    /// Judged by an error that the caller worked out.
    pub(crate) fn judged(
        tier: Tier,
        metric: impl Into<String>,
        [value, reference]: [f64; 2],
        error: f64,
        tolerance: f64,
    ) -> Self {
        let (metric, note) = (metric.into(), String::new());
        Self { tier, metric, value, reference, error, tolerance, gate: true, note }
    }

    /// Judged by the distance over the reference.
    pub(crate) fn relative(
        tier: Tier,
        metric: impl Into<String>,
        value: f64,
        reference: f64,
        tolerance: f64,
    ) -> Self {
        let error = ((value - reference) / reference).abs();
        Self::judged(tier, metric, [value, reference], error, tolerance)
    }

    /// Judged by the distance itself.
    pub(crate) fn absolute(
        tier: Tier,
        metric: impl Into<String>,
        value: f64,
        reference: f64,
        tolerance: f64,
    ) -> Self {
        let measure = Self::judged(tier, metric, [value, reference], (value - reference).abs(), tolerance);
        measure.note(ABSOLUTE)
    }

    /// With one more note.
    pub(crate) fn note(mut self, text: impl AsRef<str>) -> Self {
        if !self.note.is_empty() {
            self.note += "; ";
        }
        self.note += text.as_ref();
        self
    }

    /// A claim: printed with its verdict, but it does not gate.
    pub(crate) fn claim(self) -> Self {
        Self { gate: false, ..self }
    }
}

/// Collects the rows of a case, and the wall time of each.
#[derive(Debug)]
pub(crate) struct Rows {
    case: &'static str,
    solver: &'static str,
    rows: Vec<Row>,
    lap: Instant,
    judges_claims: bool,
}

impl Rows {
    pub(crate) fn new(case: &'static str, solver: &'static str) -> Self {
        Self { case, solver, rows: Vec::new(), lap: Instant::now(), judges_claims: true }
    }

    /// From here on so many grains are run, and a claim takes so many as `needed` to be judged by them.
    pub(crate) fn claims_need(&mut self, grains: usize, needed: usize) {
        self.judges_claims = grains >= needed;
    }

    pub(crate) fn add(&mut self, measure: Measure) {
        let Measure { tier, metric, value, reference, error, tolerance, gate, note } = measure;
        let seconds = self.lap.elapsed().as_secs_f64();
        self.lap = Instant::now();
        // Not a number passes nothing.
        let pass = error <= tolerance;
        let (case, solver) = (self.case, self.solver);
        self.rows.push(Row {
            case,
            solver,
            tier,
            metric,
            value,
            reference,
            error,
            tolerance,
            pass,
            gate,
            judged: gate || self.judges_claims,
            seconds,
            note,
        });
    }

    pub(crate) fn finish(self) -> Vec<Row> {
        self.rows
    }
}
