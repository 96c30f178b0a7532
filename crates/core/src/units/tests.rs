use super::*;
use proptest::prelude::*;

fn read(text: &str, dimension: Dimension) -> Result<f64, String> {
    parse(text, dimension).map_err(|error| error.to_string())
}

#[test]
fn the_values_of_a_scene_have_the_bits_of_si_numbers() {
    let cases = [
        ("1.15 mm", Dimension::LENGTH, 1.15e-3),
        ("2650 kg/m^3", Dimension::DENSITY, 2650.0),
        ("2.65 g/cm^3", Dimension::DENSITY, 2650.0),
        ("1.6e6 N/m", Dimension::STIFFNESS, 1.6e6),
        ("1.6E+6N/m", Dimension::STIFFNESS, 1.6e6),
        ("0.45 s", Dimension::TIME, 0.45),
        ("70 GPa", Dimension::PRESSURE, 70e9),
        ("9.81 m/s^2", Dimension::ACCELERATION, 9.81),
        ("9.81 m s^-2", Dimension::ACCELERATION, 9.81),
        ("9.81 m/s/s", Dimension::ACCELERATION, 9.81),
        ("9.81m/s²", Dimension::ACCELERATION, 9.81),
        ("1 mPa.s", Dimension::VISCOSITY, 1e-3),
        ("1 kg/(m s)", Dimension::VISCOSITY, 1.0),
        ("1 kg / (m * s)", Dimension::VISCOSITY, 1.0),
        ("3 1/s", Dimension::FREQUENCY, 3.0),
        ("3 s^-1", Dimension::FREQUENCY, 3.0),
        ("2 (m/s)^2 kg", Dimension::ENERGY, 2.0),
        ("2 N m", Dimension::ENERGY, 2.0),
        ("50 µm", Dimension::LENGTH, 50e-6),
        ("50 μm", Dimension::LENGTH, 50e-6),
        ("-.5 um", Dimension::LENGTH, -0.5e-6),
        ("+5. m", Dimension::LENGTH, 5.0),
        ("  5   m  ", Dimension::LENGTH, 5.0),
        ("5 ms", Dimension::TIME, 5e-3),
        ("5 min", Dimension::TIME, 300.0),
        ("1 h", Dimension::TIME, 3600.0),
        ("10 hPa", Dimension::PRESSURE, 1000.0),
        ("1 t/m^3", Dimension::DENSITY, 1000.0),
        ("5 %", Dimension::NUMBER, 0.05),
        ("5", Dimension::NUMBER, 5.0),
        ("5 1", Dimension::NUMBER, 5.0),
        ("5 mm/m", Dimension::NUMBER, 5e-3),
        ("0 mm", Dimension::LENGTH, 0.0),
        ("45 deg", Dimension::ANGLE, std::f64::consts::FRAC_PI_4),
        ("45°", Dimension::ANGLE, std::f64::consts::FRAC_PI_4),
        ("30 rpm", Dimension::ANGULAR_VELOCITY, std::f64::consts::PI),
        ("1e-300 kg^1", Dimension::MASS, 1e-300),
    ];
    for (text, dimension, value) in cases {
        assert_eq!(read(text, dimension), Ok(value), "{text}");
    }
}

#[test]
fn every_example_and_si_unit_reads_as_its_dimension() {
    for dimension in Dimension::ALL {
        assert!(parse(dimension.example, *dimension).is_ok(), "{}", dimension.example);
        assert_eq!(read(&format!("2 {}", dimension.unit), *dimension), Ok(2.0));
        let same = Dimension::ALL.iter().filter(|other| *other == dimension).count();
        assert_eq!(same, 1, "{}", dimension.name);
    }
}

#[test]
fn errors_name_what_was_found_and_what_is_expected() {
    let cases = [
        ("1.15 kg", Dimension::LENGTH, "`1.15 kg` is a mass, but a length such as `1 mm` is expected"),
        ("1.15", Dimension::LENGTH, "`1.15` has no unit, but a length such as `1 mm` is expected"),
        ("45 deg", Dimension::NUMBER, "`45 deg` is an angle, but a plain number such as `0.5` is expected"),
        (
            "2 Hz",
            Dimension::ANGULAR_VELOCITY,
            "`2 Hz` is a frequency, but an angular velocity such as `3 rad/s` is expected",
        ),
        (
            "1 N/m^2",
            Dimension::STIFFNESS,
            "`1 N/m^2` is a pressure, but a stiffness such as `1.6e6 N/m` is expected",
        ),
        ("1 kg m", Dimension::MASS, "`1 kg m` is measured in kg m, but a mass such as `1 g` is expected"),
        ("1 mn", Dimension::LENGTH, "unknown unit `mn`; did you mean `mm`?"),
        ("1 mn/m", Dimension::STIFFNESS, "unknown unit `mn`; did you mean `mN`?"),
        ("1 kPA", Dimension::PRESSURE, "unknown unit `kPA`; did you mean `kPa`?"),
        ("1 KG", Dimension::MASS, "unknown unit `KG`; did you mean `kg`?"),
        ("3 seconds", Dimension::TIME, "unknown unit `seconds`; did you mean `s`?"),
        ("3 degrees", Dimension::ANGLE, "unknown unit `degrees`; did you mean `deg`?"),
        ("3 furlongs", Dimension::LENGTH, "unknown unit `furlongs`; a length such as `1 mm` is expected"),
        ("mm", Dimension::LENGTH, "`mm` does not begin with a number; a length such as `1 mm` is expected"),
        ("", Dimension::LENGTH, "`` does not begin with a number; a length such as `1 mm` is expected"),
        (
            ".",
            Dimension::NUMBER,
            "`.` does not begin with a number; a plain number such as `0.5` is expected",
        ),
        ("1,5 mm", Dimension::LENGTH, "`1,5 mm`: decimals follow a point, not a comma"),
        (
            "1 kg/m s",
            Dimension::VISCOSITY,
            "`1 kg/m s`: a product after `/` can be read in two ways; use parentheses, as in `kg/(m s)`",
        ),
        ("1 kg/(m s", Dimension::VISCOSITY, "`1 kg/(m s`: a parenthesis is not closed"),
        ("1 m)", Dimension::LENGTH, "`1 m)`: a parenthesis is closed that was not opened"),
        ("1 m/", Dimension::LENGTH, "`1 m/`: a unit is missing, or is not written with letters"),
        ("1 m^x", Dimension::LENGTH, "`1 m^x`: a power is a whole number from -9 to 9, as in `m^3`"),
        ("1 m^99", Dimension::LENGTH, "`1 m^99`: a power is a whole number from -9 to 9, as in `m^3`"),
        ("1 ((m^9)^9)^9", Dimension::LENGTH, "`1 ((m^9)^9)^9`: powers as high as this measure nothing"),
        ("1 m2", Dimension::AREA, "`1 m2`: units are multiplied by `*` or a space and divided by `/`"),
        ("1 2 m", Dimension::LENGTH, "`1 2 m`: a unit is missing, or is not written with letters"),
    ];
    for (text, dimension, message) in cases {
        assert_eq!(read(text, dimension), Err(message.to_owned()));
    }
}

#[test]
fn numbers_that_a_double_cannot_hold_are_refused() {
    for text in
        ["nan", "NaN m", "inf", "-inf mm", "infinity", "1e400 m", "1e308 km", "1e-400 m", "1e99999999999 m"]
    {
        let error = parse(text, Dimension::LENGTH).unwrap_err();
        assert!(matches!(error, UnitError::OutOfRange { .. }), "{text}: {error}");
    }
}

#[test]
fn prefixes_go_with_si_units_only() {
    for text in ["1 kmin", "1 mh", "1 mdeg", "1 k%", "1 kkg", "1 mmm"] {
        let error = parse(text, Dimension::TIME).unwrap_err();
        assert!(matches!(error, UnitError::UnknownUnit { .. }), "{text}: {error}");
    }
}

#[test]
fn a_measured_value_shows_its_unit() {
    let density = Density::from(2650.0);
    assert_eq!(format!("{density} {density:?} {:.1}", Number::from(0.25)), "2650 kg/m^3 2650.0 kg/m^3 0.2");
    assert_eq!(density.to_string().parse(), Ok(density));
    assert_eq!(f64::from(density), density.value());
    assert_eq!(Length::default().value(), 0.0);
}

#[cfg(feature = "serde")]
mod scene {
    use super::*;
    use serde::de::value::{Error, F64Deserializer, I64Deserializer, StrDeserializer, UnitDeserializer};
    use serde::{Deserialize, Serialize};

    #[test]
    fn numbers_and_texts_are_read() {
        let read = |value: f64| Length::deserialize(F64Deserializer::<Error>::new(value));
        assert_eq!(read(0.5), Ok(Length::from(0.5)));
        assert_eq!(Length::deserialize(I64Deserializer::<Error>::new(-2)), Ok(Length::from(-2.0)));
        assert_eq!(Length::deserialize(StrDeserializer::<Error>::new("2 cm")), Ok(Length::from(0.02)));
        assert!(read(f64::NAN).unwrap_err().to_string().starts_with("NaN is not finite"));
        assert!(read(f64::NEG_INFINITY).is_err());
        let text = Length::deserialize(StrDeserializer::<Error>::new("2 kg")).unwrap_err();
        assert_eq!(text.to_string(), "`2 kg` is a mass, but a length such as `1 mm` is expected");
        let unit = Length::deserialize(UnitDeserializer::<Error>::new()).unwrap_err();
        assert!(unit.to_string().contains("a length, as a number in m or a text such as \"1 mm\""), "{unit}");
    }

    #[test]
    fn a_number_is_written() {
        struct Shown(Length);
        impl fmt::Display for Shown {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.serialize(f)
            }
        }
        assert_eq!(Shown(Length::from(0.02)).to_string(), "0.02");
    }

    #[test]
    fn the_schema_tells_the_unit() {
        let schema = schemars::schema_for!(Density);
        assert_eq!(schema.get("x-unit").and_then(|unit| unit.as_str()), Some("kg/m^3"));
        assert_eq!(schema.get("x-dimension").and_then(|name| name.as_str()), Some("density"));
        assert_eq!(schema.get("anyOf").and_then(|any| any.as_array()).map(Vec::len), Some(2));
    }
}

proptest! {
    #[test]
    fn a_value_comes_back_from_every_prefix(
        value in proptest::num::f64::NORMAL.prop_filter("room for prefixes", |v| (1e-200..1e200).contains(&v.abs())),
        prefix in prop::sample::select(vec![
            ("p", 1e-12), ("n", 1e-9), ("u", 1e-6), ("µ", 1e-6), ("m", 1e-3), ("c", 1e-2), ("d", 0.1),
            ("", 1.0), ("h", 1e2), ("k", 1e3), ("M", 1e6), ("G", 1e9), ("T", 1e12),
        ]),
        unit in prop::sample::select(vec![
            ("m", Dimension::LENGTH), ("s", Dimension::TIME), ("N", Dimension::FORCE), ("Pa", Dimension::PRESSURE),
            ("J", Dimension::ENERGY), ("W", Dimension::POWER), ("Hz", Dimension::FREQUENCY), ("rad", Dimension::ANGLE),
        ]),
    ) {
        let text = format!("{:e} {}{}", value / prefix.1, prefix.0, unit.0);
        let back = parse(&text, unit.1).unwrap();
        prop_assert!((back - value).abs() <= 1e-15 * value.abs(), "{text}: {back}");
    }

    #[test]
    fn what_is_shown_is_read_with_the_same_bits(value in proptest::num::f64::NORMAL) {
        prop_assert_eq!(Pressure::from(value).to_string().parse(), Ok(Pressure::from(value)));
    }

    #[test]
    fn no_text_panics(text in "\\PC*", units in "[0-9.e+-]{1,6}[ mskgNPadr%µ°²*/.^()1-9-]{0,40}") {
        for dimension in Dimension::ALL {
            let _ = parse(&text, *dimension).map_err(|error| error.to_string());
            let _ = parse(&units, *dimension).map_err(|error| error.to_string());
        }
    }
}
