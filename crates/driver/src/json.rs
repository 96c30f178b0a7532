//! Numbers that go through JSON and come back. JSON has none that is infinite or not a number: those go as text.

/// For `#[serde(with = "crate::json::number")]` on a number that may be anything.
pub(crate) mod number {
    use serde::{Deserialize, Deserializer, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
    pub(crate) fn serialize<S: Serializer>(value: &f64, to: S) -> Result<S::Ok, S::Error> {
        if value.is_finite() { to.serialize_f64(*value) } else { to.serialize_str(&value.to_string()) }
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Text(String),
            /// As files of earlier versions have it.
            Nothing,
        }
        match Written::deserialize(from)? {
            Written::Number(value) => Ok(value),
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
            Written::Nothing => Ok(f64::NAN),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde::{Deserialize, Serialize};

    #[derive(Serialize, Deserialize)]
    struct One(#[serde(with = "super::number")] f64);

    #[test]
    fn every_number_comes_back_with_the_same_bits() {
        for value in [0.1 + 0.2, -0.0, f64::MAX, 5e-324, f64::INFINITY, f64::NEG_INFINITY] {
            let text = serde_json::to_string(&One(value)).unwrap();
            let One(back) = serde_json::from_str(&text).unwrap();
            assert_eq!(back.to_bits(), value.to_bits(), "{text}");
        }
        let text = serde_json::to_string(&One(f64::NAN)).unwrap();
        assert!(serde_json::from_str::<One>(&text).unwrap().0.is_nan());
        assert!(serde_json::from_str::<One>("null").unwrap().0.is_nan());
        assert!(serde_json::from_str::<One>("\"much\"").is_err());
    }
}
