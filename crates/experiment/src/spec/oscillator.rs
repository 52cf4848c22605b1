//! `[oscillator.NAME]`: an oscillator of the library with its parameters, or `[oscillator.custom]` with
//! equations of one's own.

use std::fmt;
use std::sync::LazyLock;

use indexmap::IndexMap;
use oscillators::{Entry, Equations};
use serde::de::{DeserializeSeed, EnumAccess, Error, MapAccess, VariantAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// The name of equations that stand in the experiment file.
pub const CUSTOM: &str = "custom";

/// The oscillator at every node.
#[derive(Clone, Debug, PartialEq)]
pub enum OscillatorSpec {
    /// One of the library, with all of its parameters: what the file leaves out has its default.
    Known {
        /// Its name.
        name: &'static str,
        /// Its parameters.
        parameters: IndexMap<String, f64>,
    },
    /// Equations as text.
    Custom(Box<Equations>),
}

impl OscillatorSpec {
    /// The name of its table.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Known { name, .. } => name,
            Self::Custom(_) => CUSTOM,
        }
    }

    /// Its components, in order.
    pub fn components(&self) -> Vec<String> {
        let of = |equations: &Equations| equations.start.keys().cloned().collect();
        match self {
            Self::Known { name, .. } => {
                oscillators::find(name).map_or_else(|_| Vec::new(), |entry| of(&entry.equations))
            }
            Self::Custom(equations) => of(equations),
        }
    }

    /// Its parameters.
    pub fn parameters(&self) -> &IndexMap<String, f64> {
        match self {
            Self::Known { parameters, .. } => parameters,
            Self::Custom(equations) => &equations.parameters,
        }
    }
}

/// Names of tables, those of the library first.
static NAMES: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let library = oscillators::library().iter().map(|entry| entry.name);
    library.chain([CUSTOM]).collect()
});

impl Serialize for OscillatorSpec {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Known { name, parameters } => {
                IndexMap::from([(name, parameters)]).serialize(serializer)
            }
            Self::Custom(equations) => IndexMap::from([(CUSTOM, equations)]).serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for OscillatorSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Table;
        impl<'de> Visitor<'de> for Table {
            type Value = OscillatorSpec;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table [oscillator.NAME]")
            }
            fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<OscillatorSpec, A::Error> {
                let (name, table) = data.variant_seed(Name)?;
                match oscillators::library().iter().find(|entry| entry.name == name) {
                    Some(entry) => table.newtype_variant_seed(Parameters(entry)),
                    None => table.newtype_variant().map(Box::new).map(OscillatorSpec::Custom),
                }
            }
        }
        deserializer.deserialize_enum("oscillator", &NAMES, Table)
    }
}

/// One of [`NAMES`].
struct Name;

impl<'de> DeserializeSeed<'de> for Name {
    type Value = String;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<String, D::Error> {
        let name = String::deserialize(deserializer)?;
        if NAMES.contains(&name.as_str()) {
            return Ok(name);
        }
        Err(D::Error::unknown_variant(&name, &NAMES))
    }
}

/// Parameters of an oscillator of the library.
struct Parameters(&'static Entry);

impl<'de> DeserializeSeed<'de> for Parameters {
    type Value = OscillatorSpec;

    fn deserialize<D: Deserializer<'de>>(
        self,
        deserializer: D,
    ) -> Result<OscillatorSpec, D::Error> {
        deserializer.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Parameters {
    type Value = OscillatorSpec;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of parameters")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<OscillatorSpec, A::Error> {
        let Self(Entry { name, equations, .. }) = self;
        let mut parameters = equations.parameters.clone();
        while let Some(parameter) = map.next_key_seed(Key(&equations.parameters))? {
            parameters[parameter.as_str()] = map.next_value()?;
        }
        Ok(OscillatorSpec::Known { name, parameters })
    }
}

/// The name of a parameter.
struct Key(&'static IndexMap<String, f64>);

impl<'de> DeserializeSeed<'de> for Key {
    type Value = String;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<String, D::Error> {
        let name = String::deserialize(deserializer)?;
        if self.0.contains_key(&name) {
            return Ok(name);
        }
        let known: Vec<&str> = self.0.keys().map(String::as_str).collect();
        Err(D::Error::unknown_field(&name, known.leak()))
    }
}
