//! Integers in JSON: written as a string where a reader with f64 values would round them.

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// The largest number up to which all integers are exact in f64: 2^53.
const EXACT: u128 = 1 << 53;

/// An integer that is written without loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Whole(pub(super) i128);

impl Serialize for Whole {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match i64::try_from(self.0) {
            Ok(small) if self.0.unsigned_abs() <= EXACT => to.serialize_i64(small),
            _ => to.collect_str(&self.0),
        }
    }
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = Whole;

            fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
                to.write_str("a whole number, or a string of one")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Whole, E> {
                Ok(Whole(value.into()))
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<Whole, E> {
                Ok(Whole(value.into()))
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<Whole, E> {
                value.parse().map(Whole).map_err(E::custom)
            }
        }
        from.deserialize_any(Reader)
    }
}

/// A field of `u64`, by `#[serde(with)]`.
pub(super) mod count {
    use super::{Deserialize, Deserializer, Error, Serialize, Serializer, Whole};

    /// Writes it.
    pub(in super::super) fn serialize<S: Serializer>(
        value: &u64,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        Whole((*value).into()).serialize(to)
    }

    /// Reads it.
    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<u64, D::Error> {
        let Whole(value) = Whole::deserialize(from)?;
        u64::try_from(value).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_kept() {
        let edge = 1_i128 << 53;
        for value in [
            0,
            -1,
            edge,
            edge + 1,
            -edge,
            -edge - 1,
            i128::MAX,
            i128::MIN,
        ] {
            let text = serde_json::to_string(&Whole(value)).unwrap();
            assert_eq!(
                text.starts_with('"'),
                value.unsigned_abs() > EXACT,
                "{text}"
            );
            assert_eq!(serde_json::from_str::<Whole>(&text).unwrap(), Whole(value));
        }
        let large = u64::MAX.to_string();
        assert_eq!(
            serde_json::from_str::<Whole>(&large).unwrap(),
            Whole(u64::MAX.into())
        );
        for wrong in ["1.5", "\"x\"", "null", "[]"] {
            assert!(serde_json::from_str::<Whole>(wrong).is_err());
        }
    }
}
