use super::*;
use crate::testing::Scratch;
use proptest::prelude::*;

fn styles(n: usize) -> Vec<Style> {
    let band = Style::Band { low: vec![0.5; n], high: vec![2.0; n] };
    vec![
        Style::Line,
        Style::Markers,
        Style::LineAndMarkers,
        Style::Dashed,
        band,
        Style::ErrorBars(vec![0.3; n]),
    ]
}

pub(super) fn is_sane(figure: &Figure) -> bool {
    let (svg, png) = (figure.svg(), figure.png());
    // The letters of an image may spell anything.
    let after_image = |part: &str| part.split_once('"').map(|(_, rest)| rest.to_owned());
    let mut parts = svg.split("base64,");
    let head = parts.next().unwrap_or_default().to_owned();
    let text: String = std::iter::once(head).chain(parts.filter_map(after_image)).collect();
    png.starts_with(b"\x89PNG") && text.starts_with("<svg") && !text.contains("NaN") && !text.contains("inf")
}

#[test]
fn a_figure_is_saved_as_both_files() {
    let folder = Scratch::new("figure");
    let chart = Chart::new("E < 1 & \"more\"", Axis::linear("t [s]"), Axis::linear("E [J]"));
    let figure = chart.note("seed 7").figure();
    let paths = figure.save(&folder.path("energy.t1.5")).unwrap();
    assert_eq!(folder.names(), ["energy.t1.5.png", "energy.t1.5.svg"]);
    assert!(std::fs::read_to_string(&paths[0]).unwrap().contains("E &lt; 1 &amp; &quot;more&quot;"));
    assert_eq!(figure.size(), [640.0, 440.0]);
    let missing = figure.save(&folder.path("no/such")).unwrap_err();
    assert!(missing.to_string().contains("no/such.svg"));
}

#[test]
fn odd_data_still_give_a_figure() {
    let odd: [&[[f64; 2]]; 6] = [
        &[],
        &[[f64::NAN, 1.0]],
        &[[1.0, 1.0]],
        &[[1.0, 2.0], [1.0, 2.0], [f64::INFINITY, 3.0], [2.0, 2.0]],
        &[[-1e308, 1e308], [1e308, -1e308], [0.0, 0.0]],
        &[[1e-310, 5e-324], [3e-308, 1.0]],
    ];
    for points in odd {
        for (x, y) in
            [(Axis::linear("x"), Axis::log("")), (Axis::log("x"), Axis::linear("y").range(3.0, 3.0))]
        {
            let mut chart = Chart::new("", x, y);
            for style in styles(points.len()) {
                chart = chart.with(Series::new("a label", points.to_vec(), style));
            }
            assert!(is_sane(&chart.figure()), "{points:?}");
            assert!(is_sane(&chart.figure_of(1.0, 50.0)), "{points:?}");
        }
    }
    assert!(is_sane(&Panels::new("none", 0, vec![]).figure()));
    assert!(is_sane(&GrainFigure::default().figure()));
}

#[test]
fn odd_grains_still_give_a_figure() {
    let grain = |x: f64, radius: f64, value: f64| Grain { center: [x, 0.0], radius, value };
    let chain = Chain { from: [0.0, 0.0], to: [f64::NAN, 1.0], force: 2.0 };
    let grains = vec![
        grain(0.0, 1.0, f64::NAN),
        grain(f64::NAN, 1.0, 1.0),
        grain(1.0, -1.0, 1.0),
        grain(2.0, 0.0, 1e308),
        grain(3.0, f64::INFINITY, -1e308),
    ];
    let walls = vec![[[0.0, f64::INFINITY], [1.0, 1.0]]];
    let panel =
        GrainPanel { label: "odd".into(), grains, walls, chains: vec![chain], ..GrainPanel::default() };
    let mut figure = GrainFigure::new("odd", "v [m/s]", vec![panel.clone(), panel]);
    assert!(is_sane(&figure.figure()));
    figure.corners = Some([[1.0, 1.0], [0.0, f64::NAN]]);
    figure.columns = 9;
    figure.width = f64::NAN;
    assert!(is_sane(&figure.figure()));
}

#[test]
fn text_in_a_drawing_stays_text() {
    let chart = Chart::new("Cooling & more", Axis::linear("time [s]"), Axis::linear("T / T₀ [-]"));
    let svg = chart.with(Series::new("run 7", vec![[0.0, 1.0], [1.0, 0.5]], Style::Line)).figure().svg();
    for label in ["Cooling &amp; more", "time [s]", "T / T₀ [-]", "run 7", "0.5"] {
        assert!(svg.contains(&format!(">{label}</text>")), "{label}: {svg}");
    }
    // The label of the axis at the left is read upwards, and each text keeps its width in any font.
    assert!(
        svg.contains("rotate(-90 ") && svg.matches("textLength=").count() == svg.matches("</text>").count()
    );
}

#[test]
fn marks_have_names_and_are_within_the_figure() {
    let edge = |closed, dashed, label: &str| Mark {
        points: vec![[0.0, 0.0], [4.0, 0.0], [4.0, 2.0]],
        closed,
        dashed,
        label: label.to_owned(),
    };
    let point = Mark { points: vec![[9.0, 3.0]], label: "gauge".into(), ..Mark::default() };
    let marks = vec![edge(true, true, "rain"), edge(false, false, ""), point, Mark::default()];
    let odd = Mark { points: vec![[f64::NAN, 0.0]], label: "odd".into(), ..Mark::default() };
    let panel = GrainPanel { marks: [marks, vec![odd]].concat(), ..GrainPanel::default() };
    let mut figure = GrainFigure::new("", "", vec![panel]);
    figure.note = "two edges".to_owned();
    let svg = figure.figure().svg();
    assert!(is_sane(&figure.figure()), "{svg}");
    for label in ["rain", "gauge", "two edges", "8"] {
        assert!(svg.contains(&format!(">{label}</text>")), "{label}: {svg}");
    }
    assert!(!svg.contains(">odd<") && svg.matches("stroke-dasharray").count() == 3, "{svg}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_data_make_a_chart_panic(
        points in proptest::collection::vec(any::<[f64; 2]>(), 0..12),
        log: [bool; 2],
        range in proptest::option::of(any::<[f64; 2]>()),
    ) {
        let axis = |log, range| Axis { label: "q".into(), scale: if log { Scale::Log } else { Scale::Linear }, range };
        let mut chart = Chart::new("any", axis(log[0], None), axis(log[1], range));
        for style in styles(points.len()) {
            chart = chart.with(Series::new("s", points.clone(), style));
        }
        prop_assert!(is_sane(&chart.figure_of(200.0, 150.0)));
    }
}

#[test]
fn cells_are_grey_by_their_value_and_grains_above_them_are_rings() {
    let square = |x: f64, value: f64| Patch {
        outline: vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]],
        value,
    };
    let grains = vec![Grain { center: [0.5, 0.5], radius: 0.5, value: 7.0 }];
    let cells = vec![square(0.0, 0.6), square(1.0, 0.9), square(2.0, f64::NAN)];
    let panel = GrainPanel { grains, cells, ..GrainPanel::default() };
    let svg = GrainFigure::new("", "density [-]", vec![panel]).figure().svg();
    let [light, dark] = [0.0, 1.0].map(|share| colour::Colour::of_density(share).hex());
    assert!(svg.contains(&format!("fill=\"{light}\"")) && svg.contains(&format!("fill=\"{dark}\"")), "{svg}");
    // A cell without a value and the grain have no fill.
    assert!(svg.contains("<circle") && svg.matches("fill=\"none\"").count() >= 2);
}
