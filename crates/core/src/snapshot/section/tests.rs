use super::*;
use glam::{DVec2, DVec3};

#[test]
fn what_is_put_comes_back_and_the_rest_is_named() {
    let mut section = Section::new("grains");
    section.put("position", &[DVec2::new(1.0, f64::MIN_POSITIVE), DVec2::new(-0.0, 2.0)]);
    section.put_one("step", 7_u64);
    section.put_text("scene", "μ");
    let back: Vec<DVec2> = section.array_of("position", 2).unwrap();
    assert_eq!(back[1].x.to_bits(), (-0.0_f64).to_bits());
    assert_eq!(section.one::<u64>("step").unwrap(), 7);
    assert_eq!(section.text("scene").unwrap(), "μ");
    let missing = section.one::<u64>("clock").unwrap_err();
    assert_eq!(missing.to_string(), "the snapshot has no section `grains/clock`");
    let wrong = section.array_of::<DVec2>("position", 3).unwrap_err();
    assert!(wrong.to_string().contains("2 values where 3 are expected"));
    assert!(section.array::<DVec3>("position").is_err());
}

/// Keeps names and bytes.
#[derive(Default)]
struct Kept(Vec<(String, u64, Vec<u8>)>);

impl EntrySink for Kept {
    fn begin(&mut self, name: &str, bytes: u64) -> bool {
        self.0.push((name.to_owned(), bytes, Vec::new()));
        name != "unwanted"
    }
    fn bytes(&mut self, bytes: &[u8]) {
        assert!(bytes.len() < PIECE + 100, "a piece of {} bytes", bytes.len());
        self.0.last_mut().expect("an entry has begun").2.extend_from_slice(bytes);
    }
}

#[test]
fn a_section_that_passes_on_gives_the_same_bytes_in_pieces() {
    let fill = |section: &mut Section| {
        let positions: Vec<DVec3> = (0..5000).map(|k| DVec3::splat(f64::from(k))).collect();
        section.put("position", &positions);
        section.put_one("step", 7_u64);
        section.put_text("scene", "μ");
        section.put::<f64>("none", &[]);
        section.put_each("squares", 3, |put| (0..3_u32).for_each(|k| put(k * k)));
        section.put_bytes("raw", vec![1, 2, 3]);
    };
    let mut kept = Section::new("grains");
    fill(&mut kept);
    let mut passing = Section::passing_on("grains", Kept::default());
    fill(&mut passing);
    assert_eq!(passing.entries().count(), 0);
    let passed = passing.into_sink::<Kept>().expect("it is what was given").0;
    let expected: Vec<_> =
        kept.entries().map(|(name, bytes)| (name.to_owned(), bytes.len() as u64, bytes.to_vec())).collect();
    assert_eq!(passed, expected);
    assert!(Section::new("grains").into_sink::<Kept>().is_none());
    // What is not wanted is not worked out.
    let mut passing = Section::passing_on("grains", Kept::default());
    passing.put_each::<f64>("unwanted", 1 << 40, |_| panic!("nobody wants it"));
    let passed = passing.into_sink::<Kept>().expect("it is what was given").0;
    assert_eq!(passed, [("unwanted".to_owned(), 8 << 40, Vec::new())]);
}

#[test]
#[should_panic(expected = "entry `a` has another number of values than was said")]
fn a_wrong_count_is_an_error_of_the_program() {
    Section::new("grains").put_each("a", 2, |put| put(1.0_f64));
}
