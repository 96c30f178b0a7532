//! Columns of a table over time, or over another column.

use super::{Units, title};
use crate::scene::{ReferenceCurve, Scene};
use granular_io::Table;
use granular_io::figure::{Axis, Chart, Panels, Series, Style};

/// What a figure of columns shows.
pub(super) struct Columns<'a> {
    pub(super) names: &'a [String],
    /// Column along the other axis; time without.
    pub(super) over: Option<&'a str>,
    /// From when on; all of the run without.
    pub(super) units: Option<Units>,
    pub(super) references: &'a [ReferenceCurve],
}

/// Columns over time or over another column: one chart for each unit, above one another. Curves from elsewhere are in the
/// unit of the first column.
pub(super) fn panels(scene: &Scene, table: &Table, columns: &Columns<'_>) -> Panels {
    let unit_of = |name: &String| table.unit(name).unwrap_or("-");
    let mut units: Vec<&str> = Vec::new();
    for unit in columns.names.iter().map(unit_of) {
        if !units.contains(&unit) {
            units.push(unit);
        }
    }
    let of_unit = |unit: &&str| {
        let names: Vec<&String> = columns.names.iter().filter(|name| unit_of(name) == *unit).collect();
        chart(table, &names, unit, columns)
    };
    let mut charts: Vec<Chart> = units.iter().map(of_unit).collect();
    if let Some(first) = charts.first_mut() {
        *first = with_references(std::mem::take(first), columns.references);
    }
    let heading = match (scene.title.as_str(), columns.over) {
        ("", None) => "Series over time".to_owned(),
        (known, None) => known.to_owned(),
        (_, Some(over)) => {
            let [one, ..] = columns.names else { return Panels::default() };
            let what = if columns.names.len() == 1 { words(one) } else { "columns".to_owned() };
            title(scene, &format!("{what} over {}", words(over)))
        }
    };
    let height = if charts.len() > 1 { 300.0 } else { 406.0 };
    Panels { size: [640.0, height], ..Panels::new(heading, 1, charts) }
}

fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// The columns of one unit.
fn chart(table: &Table, names: &[&String], unit: &str, columns: &Columns<'_>) -> Chart {
    let label = match names {
        [one] => format!("{} [{unit}]", words(one)),
        _ => format!("[{unit}]"),
    };
    let time_label = columns.units.map_or("time [s]", |units| units.time_label());
    let x_label = match columns.over {
        Some(over) => format!("{} [{}]", words(over), table.unit(over).unwrap_or("-")),
        None => time_label.to_owned(),
    };
    let time = table.column("time").unwrap_or_default();
    let x: Vec<f64> = match (columns.over, columns.units) {
        (Some(over), _) => table.column(over).unwrap_or_default(),
        (None, Some(units)) => time.iter().map(|t| (t - units.start) / units.time).collect(),
        (None, None) => time.clone(),
    };
    let start = columns.units.map_or(f64::NEG_INFINITY, |units| units.start);
    let mut chart = Chart::new("", Axis::linear(x_label), Axis::linear(label));
    for name in names {
        let values = table.column(name).unwrap_or_default();
        let rows = time.iter().zip(&x).zip(values).filter(|((t, _), _)| **t >= start);
        let points = rows.map(|((_, x), value)| [*x, value]).collect();
        let label = if columns.names.len() > 1 { words(name) } else { String::new() };
        chart = chart.with(Series::new(label, points, Style::Line));
    }
    chart
}

/// A chart with curves from elsewhere, beside which a curve without a label is this run.
pub(super) fn with_references(mut chart: Chart, references: &[ReferenceCurve]) -> Chart {
    if !references.is_empty() {
        let unnamed = chart.series.iter_mut().filter(|series| series.label.is_empty());
        unnamed.for_each(|series| series.label = "this run".to_owned());
    }
    for reference in references {
        let points = reference.points.iter().map(|(x, y)| [*x, *y]).collect();
        let style = if reference.line { Style::Dashed } else { Style::Markers };
        chart = chart.with(Series::new(reference.label.clone(), points, style));
    }
    chart
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns =
            [("time", "s"), ("strain", "1"), ("stress", "Pa"), ("stress_xy", "Pa"), ("density", "1")];
        let columns = columns.map(|(name, unit)| (name.to_owned(), unit.to_owned())).to_vec();
        let rows =
            vec![vec![0.0, 0.0, 5.0, 1.0, 0.7], vec![1.0, 0.1, 6.0, 2.0, 0.8], vec![2.0, 0.3, 4.0, 3.0, 0.9]];
        Table { columns, rows }
    }

    fn scene() -> Scene {
        let (name, text) = crate::TEMPLATES[2];
        crate::scene_file::SceneText::new(name, text).parse().unwrap()
    }

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    fn over<'a>(names: &'a [String], over: Option<&'a str>) -> Columns<'a> {
        Columns { names, over, units: None, references: &[] }
    }

    #[test]
    fn a_series_from_a_stage_on_counts_in_its_unit() {
        let one = names(&["density"]);
        let all = panels(&scene(), &table(), &over(&one, None));
        assert_eq!(all.charts[0].series[0].points, [[0.0, 0.7], [1.0, 0.8], [2.0, 0.9]]);
        let units = Some(Units { start: 1.0, time: 0.5, scaled: true });
        let part = panels(&scene(), &table(), &Columns { units, ..over(&one, None) });
        assert_eq!(part.charts[0].series[0].points, [[0.0, 0.8], [2.0, 0.9]]);
    }

    #[test]
    fn stress_over_strain_is_a_curve_and_each_unit_has_an_axis() {
        let wanted = names(&["stress", "density", "stress_xy"]);
        let found = panels(&scene(), &table(), &over(&wanted, Some("strain")));
        let axes: Vec<&str> = found.charts.iter().map(|chart| chart.y.label.as_str()).collect();
        assert_eq!(axes, ["[Pa]", "density [1]"]);
        let [stresses, density] = &found.charts[..] else { panic!("two charts") };
        assert_eq!(stresses.series[0].points, [[0.0, 5.0], [0.1, 6.0], [0.3, 4.0]]);
        assert_eq!(stresses.series[1].points, [[0.0, 1.0], [0.1, 2.0], [0.3, 3.0]]);
        assert_eq!(stresses.series[1].label, "stress xy");
        assert_eq!(density.series[0].points, [[0.0, 0.7], [0.1, 0.8], [0.3, 0.9]]);
        assert_eq!((stresses.x.label.as_str(), density.x.label.as_str()), ("strain [1]", "strain [1]"));
        // Over time the same: no column hides behind the unit of another.
        let found = panels(&scene(), &table(), &over(&wanted, None));
        assert_eq!((found.charts.len(), found.charts[0].x.label.as_str()), (2, "time [s]"));
        // A stage cuts the rows by their time.
        let units = Some(Units { start: 1.0, time: 1.0, scaled: false });
        let one = names(&["stress"]);
        let part = panels(&scene(), &table(), &Columns { units, ..over(&one, Some("strain")) });
        assert_eq!(part.charts[0].series[0].points, [[0.1, 6.0], [0.3, 4.0]]);
    }

    #[test]
    fn curves_from_elsewhere_lie_beside_this_run() {
        let one = names(&["density"]);
        let references =
            [ReferenceCurve { label: "thesis".to_owned(), points: vec![(0.0, 0.75)], line: true }];
        let columns = Columns { references: &references, ..over(&one, None) };
        let chart = panels(&scene(), &table(), &columns).charts.remove(0);
        let labels: Vec<&str> = chart.series.iter().map(|series| series.label.as_str()).collect();
        assert_eq!(labels, ["this run", "thesis"]);
        assert_eq!(
            (&chart.series[1].points[..], &chart.series[1].style),
            (&[[0.0, 0.75]][..], &Style::Dashed)
        );
    }
}
