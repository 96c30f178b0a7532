//! Times of figures: in seconds, or in those of a column that spreads.

use crate::column::ColumnSize;
use crate::records::StageRecord;
use crate::scene::{Change, FigureSpec, Scene, Stage, WallSpec};

/// Lengths and times that a figure is drawn in.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    /// Simulated time from which the figure counts \[s\].
    pub(super) start: f64,
    /// Time of the axis \[s\]: sqrt(H/g) of a column, else one second.
    pub(super) time: f64,
    /// Whether `time` is sqrt(H/g).
    pub(super) scaled: bool,
}

/// sqrt(H/g) \[s\].
pub(super) fn gravity_time(scene: &Scene, height: f64) -> Option<f64> {
    let gravity = scene.gravity.iter().map(|g| g.value() * g.value()).sum::<f64>().sqrt();
    (gravity > 0.0 && height > 0.0).then(|| (height / gravity).sqrt())
}

/// Whether the sample is a column that spreads: behind a gate, or with nothing at its right. In a silo lengths over the
/// width of the column and times over sqrt(H/g) mean nothing.
pub(super) fn spreads(scene: &Scene) -> bool {
    let is_asked =
        |figure: &FigureSpec| matches!(figure, FigureSpec::Runout { .. } | FigureSpec::RadialProfile { .. });
    let is_released = |stage: &Stage| {
        stage.changes.iter().any(|change| matches!(change, Change::Open(name) if name == "right"))
    };
    let beside = |wall: &WallSpec| {
        matches!(wall, WallSpec::Floor { .. } | WallSpec::Left { .. } | WallSpec::Sides { .. })
    };
    let is_gate = |wall: &WallSpec| matches!(wall, WallSpec::Gate { .. });
    let comes_and_goes = !(scene.inlets.is_empty() && scene.outlets.is_empty() && scene.cell.is_none());
    scene.figures.iter().any(is_asked)
        || scene.walls.iter().any(is_gate)
        || scene.stages.iter().any(is_released)
        || (!comes_and_goes && scene.walls.iter().all(beside))
}

/// Share of the height of a column as it is built that it has at least when it is released.
const SETTLED: f64 = 0.5;

/// Times of figures that come after the longest that a run can last.
pub(crate) fn times_beyond(scene: &Scene, column: Option<ColumnSize>) -> Vec<String> {
    let mut found = Vec::new();
    for (k, figure) in scene.figures.iter().enumerate() {
        let stage = figure.needs("front").stage;
        let first = scene.stages.iter().position(|other| stage == Some(other.name.as_str()));
        let Some(first) = first else { continue };
        let longest: f64 = scene.stages[first..].iter().map(|stage| stage.end.longest()).sum();
        let of_column = column.filter(|_| figure.is_scaled() && spreads(scene));
        let unit = of_column.and_then(|column| gravity_time(scene, SETTLED * column.height));
        let (unit, units) = unit.map_or((1.0, "s"), |unit| (unit, "√(H₀/g)"));
        let beyond = figure.times().iter().filter(|time| **time * unit > longest * (1.0 + 1e-9));
        let beyond: Vec<String> = beyond.map(|time| format!("{time} {units}")).collect();
        if !beyond.is_empty() {
            found.push(format!(
                "figures.{k} `{}`: the run ends before {}; from the start of `{}` on it lasts at most {longest} s",
                figure.path(),
                beyond.join(", "),
                scene.stages[first].name,
            ));
        }
    }
    found
}

/// The units of times after the start of a stage.
pub(super) fn units(scene: &Scene, record: &StageRecord, column: Option<ColumnSize>) -> Units {
    let time = column.filter(|_| spreads(scene)).and_then(|_| gravity_time(scene, record.height));
    Units { start: record.start, time: time.unwrap_or(1.0), scaled: time.is_some() }
}

impl Units {
    /// Label of the axis.
    pub(super) fn time_label(&self) -> &'static str {
        match (self.scaled, self.start > 0.0) {
            (true, _) => "time after release, t / √(H₀/g) [-]",
            (false, true) => "time since the stage began [s]",
            (false, false) => "time [s]",
        }
    }

    /// How a time in these units is written.
    pub(super) fn name_of(&self, time: f64) -> String {
        if self.scaled { format!("t = {time} √(H₀/g)") } else { format!("t = {time} s") }
    }

    /// How a simulated time \[s\] is written.
    pub(super) fn label(&self, simulated: f64) -> String {
        let since = simulated - self.start;
        // Differences of round-off are none.
        let since = if since.abs() <= 1e-12 * simulated.abs() { 0.0 } else { since / self.time };
        let rounded = if self.scaled { (100.0 * since).round() / 100.0 } else { four_digits(since) };
        // Zero has no sign.
        self.name_of(rounded + 0.0)
    }
}

/// A time rounded to four digits: output times are those of the first step at or after the one asked for.
fn four_digits(time: f64) -> f64 {
    if time == 0.0 {
        return 0.0;
    }
    let unit = 10.0_f64.powi(time.abs().log10().floor() as i32 - 3);
    // Divided by a whole number where there is one, so that the result prints short.
    if unit < 1.0 { (time / unit).round() / (1.0 / unit).round() } else { (time / unit).round() * unit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file::SceneText;

    fn template(edits: &[&str]) -> Scene {
        let (name, text) = crate::TEMPLATES.iter().find(|(name, _)| *name == "sample").unwrap();
        let mut text = SceneText::new(*name, *text);
        edits.iter().for_each(|edit| text.set(edit).unwrap());
        text.parse().unwrap()
    }

    #[test]
    fn a_column_that_is_held_in_a_silo_has_seconds_and_one_that_spreads_its_own_time() {
        let silo = template(&[]);
        assert!(silo.walls.iter().any(|wall| matches!(wall, WallSpec::Right { .. })));
        let (front, height) = (0.05, 0.0981);
        let record = StageRecord { name: "settle".to_owned(), start: 0.5, front, height, push: None };
        let column = Some(ColumnSize { width: 0.05, height: 0.1, depth: None, round: None });
        let found = units(&silo, &record, column);
        assert_eq!(
            (found.scaled, found.time, found.time_label()),
            (false, 1.0, "time since the stage began [s]")
        );
        let spread = template(&["walls=[Floor(material: \"wall\"), Left(material: \"wall\")]"]);
        assert!(spreads(&spread));
        let gate = "walls=[Right(material: \"wall\"), Gate(material: \"wall\", opens: \"settle\")]";
        let found = units(&template(&[gate]), &record, column);
        assert!(found.scaled && (found.time - 0.1).abs() < 1e-12, "{found:?}");
        // Without a column there is no such time.
        assert!(!units(&spread, &record, None).scaled);
    }

    #[test]
    fn times_are_written_with_the_digits_that_they_have() {
        let seconds = Units { start: 0.3, time: 1.0, scaled: false };
        assert_eq!(seconds.label(0.1 + 0.2), "t = 0 s");
        assert_eq!(seconds.label(0.304), "t = 0.004 s");
        let scaled = Units { start: 0.3, time: 0.1, scaled: true };
        assert_eq!(
            (scaled.label(0.2999), scaled.label(0.27)),
            ("t = 0 √(H₀/g)".to_owned(), "t = -0.3 √(H₀/g)".to_owned())
        );
    }
}
