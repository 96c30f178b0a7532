//! Measured values in scene files and their schema.

use super::{Measured, Unit, parse};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::ser::{Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// Writes the number in SI units.
impl<U: Unit> Serialize for Measured<U> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.value())
    }
}

/// Reads a finite number in SI units or a text with its unit.
impl<'de, U: Unit> Deserialize<'de> for Measured<U> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrText(PhantomData))
    }
}

struct NumberOrText<U>(PhantomData<U>);

impl<U: Unit> Visitor<'_> for NumberOrText<U> {
    type Value = Measured<U>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let dimension = U::DIMENSION;
        write!(f, "{}, as ", dimension.with_article())?;
        if !dimension.is_number() {
            write!(f, "a number in {} or ", dimension.unit)?;
        }
        write!(f, "a text such as \"{}\"", dimension.example)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        if value.is_finite() {
            Ok(value.into())
        } else {
            let dimension = U::DIMENSION;
            Err(E::custom(format_args!(
                "{value} is not finite; {} such as `{}` is expected",
                dimension.with_article(),
                dimension.example
            )))
        }
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        Ok((value as f64).into())
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
        Ok((value as f64).into())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
        parse(text, U::DIMENSION).map(Measured::from).map_err(E::custom)
    }
}

/// A number or a text, with the SI unit under `x-unit` and the dimension under `x-dimension`.
impl<U: Unit> JsonSchema for Measured<U> {
    // Written in place, so that a reference shows the unit next to each key.
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        U::DIMENSION.name.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let dimension = U::DIMENSION;
        let article = dimension.with_article();
        json_schema!({
            "anyOf": [{ "type": "number" }, { "type": "string" }],
            "description":
                format!("{article} in {}, or a text such as \"{}\"", dimension.unit, dimension.example),
            "examples": [dimension.example],
            "x-unit": dimension.unit,
            "x-dimension": dimension.name,
        })
    }
}
