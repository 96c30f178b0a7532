use super::*;
use crate::figure::tests::is_sane;
use proptest::prelude::*;
use tiny_skia::Pixmap;

const GREY: [u8; 3] = Colour::NEUTRAL.0;

fn panel(cells: [usize; 2], value: impl Fn(usize) -> f64) -> MapPanel {
    let values = (0..cells[0] * cells[1]).map(value).collect();
    MapPanel { cells, values, ..MapPanel::default() }
}

fn figure(panel: MapPanel) -> MapFigure {
    let corners = [[0.0, 0.0], panel.cells.map(|n| n as f64)];
    MapFigure::new("map", "value [-]", corners, vec![panel])
}

/// Where the map of the first panel lies, from the text of the image.
fn area_in(svg: &str) -> Area {
    let image = svg.split("<image ").nth(1).unwrap();
    let number = |name: &str| -> f64 {
        let text = image.split(&format!("{name}=\"")).nth(1).unwrap();
        text.split('"').next().unwrap().parse().unwrap()
    };
    let (left, top) = (number("x"), number("y"));
    Area { left, top, right: left + number("width"), bottom: top + number("height") }
}

/// The colour in the PNG at a place in cells from the lower left.
fn colour_at(figure: &MapFigure, [x, y]: [f64; 2]) -> [u8; 3] {
    let figure_cells = figure.panels[0].cells.map(|n| n as f64);
    let drawn = figure.figure();
    let area = area_in(&drawn.svg());
    let pixels = Pixmap::decode_png(&drawn.png()).unwrap();
    let left = area.left + area.width() * x / figure_cells[0];
    let top = area.bottom - area.height() * y / figure_cells[1];
    let pixel = pixels.pixel((2.0 * left) as u32, (2.0 * top) as u32).unwrap();
    assert_eq!(pixel.alpha(), 255);
    [pixel.red(), pixel.green(), pixel.blue()]
}

#[test]
fn a_map_is_one_image_with_the_colours_of_its_cells() {
    let values = |i: usize| if i == 6 { f64::NAN } else { i as f64 };
    let figure = figure(panel([4, 2], values));
    let svg = figure.figure().svg();
    assert_eq!(svg.matches("<image ").count(), 1);
    assert!(svg.contains("image-rendering=\"pixelated\" href=\"data:image/png;base64,iVBOR"));
    for i in [0, 1, 3, 4, 5, 7] {
        let expected = Colour::of_share(i as f64 / 7.0).0;
        let [x, y] = [(i % 4) as f64, (i / 4) as f64];
        // From edge to edge of the cell.
        for shift in [0.03, 0.5, 0.97] {
            assert_eq!(colour_at(&figure, [x + shift, y + shift]), expected, "cell {i}");
        }
    }
    assert_eq!(colour_at(&figure, [2.5, 1.5]), GREY);
}

#[test]
fn panels_share_their_colours_and_the_aspect_ratio_is_kept() {
    let mut map = figure(panel([22, 4], |_| 1.0));
    map.panels.push(panel([22, 4], |_| 3.0));
    assert_eq!(map.range(), [1.0, 3.0]);
    let svg = map.figure().svg();
    assert_eq!(svg.matches("<image ").count(), 2);
    let area = area_in(&svg);
    assert!((area.width() / area.height() - 5.5).abs() < 1e-3);
    assert_eq!(colour_at(&map, [3.0, 2.0]), Colour::of_share(0.0).0);
    map.values = Some([0.0, 2.0]);
    assert_eq!(colour_at(&map, [3.0, 2.0]), Colour::of_share(0.5).0);
}

#[test]
fn signed_colours_are_symmetric_and_bear_extreme_cells() {
    let wave = |i: usize| (i as f64 * 0.37).sin();
    let mut map = MapFigure { diverging: true, ..figure(panel([50, 20], wave)) };
    let [low, high] = map.range();
    let largest = (0..1000).map(|i| wave(i).abs()).fold(0.0, f64::max);
    assert_eq!([low, high], [-largest, largest], "no cell is extreme");
    map.panels[0].values[500] = -1e6;
    map.panels[0].values[501] = 0.0;
    map.panels[0].values[502] = f64::INFINITY;
    let [low, high] = map.range();
    assert!(low == -high && high <= 1.0 && high > 0.99, "{high}");
    assert_eq!(colour_at(&map, [0.5, 10.5]), Colour::of_signed_share(0.0).0);
    assert_eq!(colour_at(&map, [1.5, 10.5]), [247; 3]);
    assert_eq!(colour_at(&map, [2.5, 10.5]), GREY);
    map.values = Some([-2.0, 1.0]);
    assert_eq!(map.range(), [-2.0, 2.0]);
    let rare = figure(panel([50, 20], |i| if i == 7 { -3.0 } else { 0.0 }));
    assert_eq!(MapFigure { diverging: true, ..rare }.range(), [-3.0, 3.0]);
}

#[test]
fn images_are_no_larger_than_what_can_be_seen() {
    assert_eq!(pixels_for([40, 30], [590.0, 400.0]), [40, 30]);
    assert_eq!(pixels_for([2200, 410], [590.0, 110.0]), [1475, 275]);
    assert_eq!(pixels_for([90_000, 2], [5000.0, 400.0]), [LONGEST, 2]);
    assert_eq!(pixels_for([3000, 3000], [860.0, 860.0]), [1000, 1000]);
    assert_eq!(pixels_for([3000, 3000], [0.0, f64::NAN]), [1, 1]);
    let value = |i: usize| ((i % 2200) as f64 * 0.02).sin() * ((i / 2200) as f64 * 0.05).cos();
    for diverging in [false, true] {
        let map = MapFigure { diverging, ..figure(panel([2200, 410], value)) };
        let size = map.figure().svg().len();
        assert!(size < 1_000_000, "{size} bytes");
    }
}

#[test]
fn a_pixel_of_several_cells_has_their_mean() {
    let size = [590.0, 100.0];
    let paint = |value: f64| if value.is_nan() { Colour(GREY) } else { Colour::of_share(value) };
    let stripes = panel([2950, 3], |i| (i % 2) as f64);
    let image = stripes.image(size, &paint).unwrap();
    assert_eq!([image.width(), image.height()], [1475, 3]);
    for x in 0..image.width() {
        assert_eq!(image.at(x, 1), Colour::of_share(0.5));
    }
    // Cells without a value make a pixel grey when they are most of it.
    let holes = panel([4 * 1475, 1], |i| if i < 4 && i != 2 || i == 4 { f64::NAN } else { 0.5 });
    let image = holes.image(size, &paint).unwrap();
    assert_eq!([image.at(0, 0), image.at(1, 0)], [Colour(GREY), Colour::of_share(0.5)]);
}

#[test]
fn outlines_are_closed_and_end_at_the_edge() {
    let mut map = figure(panel([10, 10], |_| 1.0));
    let plain = map.figure().svg();
    map.panels[0].outlines =
        vec![vec![[20.0, 20.0], [30.0, 20.0], [30.0, 30.0]], vec![], vec![[1.0, f64::NAN]; 3]];
    assert_eq!(map.figure().svg(), plain, "nothing of these can be seen");
    map.panels[0].outlines = vec![vec![[2.0, 2.0], [15.0, 2.0], [15.0, 8.0], [2.0, 8.0]]];
    let inside = Colour::of_share(0.5).0;
    assert_eq!(colour_at(&map, [5.0, 5.0]), inside);
    for at in [[2.0, 5.0], [5.0, 2.0], [5.0, 8.0]] {
        let dark = colour_at(&map, at);
        assert!(dark.iter().zip(inside).all(|(line, cell)| *line < cell), "{at:?}: {dark:?}");
    }
    assert!(is_sane(&map.figure()));
}

#[test]
fn odd_maps_still_give_a_figure() {
    let nan = |_| f64::NAN;
    let panels = [
        panel([1, 1], |_| 3.0),
        panel([3, 2], |_| 0.0),
        panel([3, 2], nan),
        panel([1, 1], nan),
        panel([0, 5], nan),
        panel([5000, 1], |i| i as f64),
        panel([2, 2], |i| [1e308, -1e308, f64::INFINITY, 5e-324][i]),
        MapPanel { cells: [usize::MAX; 2], values: vec![1.0], ..MapPanel::default() },
        MapPanel { cells: [2, 2], values: vec![1.0; 3], ..MapPanel::default() },
    ];
    for diverging in [false, true] {
        for panel in &panels {
            let map = MapFigure { diverging, ..figure(panel.clone()) };
            assert!(is_sane(&map.figure()), "{panel:?}");
        }
        let all =
            MapFigure { diverging, columns: 4, ..MapFigure::new("", "v", [[0.0; 2]; 2], panels.to_vec()) };
        assert!(is_sane(&all.figure()));
    }
    assert!(is_sane(&MapFigure::default().figure()));
    let all_nan = figure(panels[2].clone());
    assert_eq!(colour_at(&all_nan, [1.5, 0.5]), GREY);
    assert_eq!(colour_at(&figure(panels[0].clone()), [0.5, 0.5]), Colour::of_share(0.5).0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_values_make_a_map_panic(
        values in proptest::collection::vec(any::<f64>(), 12),
        corners: [[f64; 2]; 2],
        range in proptest::option::of(any::<[f64; 2]>()),
        outline in proptest::collection::vec(any::<[f64; 2]>(), 0..5),
        diverging: bool,
        width: f64,
    ) {
        let panel = MapPanel { cells: [3, 4], values, outlines: vec![outline], label: "a".into(), disks: Vec::new() };
        let map = MapFigure { diverging, values: range, width, ..MapFigure::new("m", "q", corners, vec![panel]) };
        prop_assert!(is_sane(&map.figure()));
    }
}

#[test]
fn disks_are_drawn_in_the_unit_of_the_axes_and_only_within_the_map() {
    let disk = |center: [f64; 2], radius: f64| MapDisk { center, radius };
    let disks = vec![
        disk([5.0, 5.0], 2.0),
        disk([12.0, 5.0], 1.0),
        disk([2.0, 2.0], 0.0),
        disk([f64::NAN, 1.0], 1.0),
    ];
    let panel = MapPanel { cells: [2, 2], values: vec![0.0; 4], disks, ..MapPanel::default() };
    let map = MapFigure::new("", "speed", [[0.0, 0.0], [10.0, 10.0]], vec![panel]);
    let svg = map.figure().svg();
    assert_eq!(svg.matches("<circle").count(), 1);
    let bare = MapFigure { panels: vec![MapPanel { disks: Vec::new(), ..map.panels[0].clone() }], ..map };
    assert_eq!(bare.figure().svg().matches("<circle").count(), 0);
}
