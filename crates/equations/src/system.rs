//! A system of equations: components, their equations, named subexpressions and parameters, resolved
//! so that every name means one thing.

use std::collections::HashMap;
use std::fmt;
use std::ops::Range;

use crate::expression::Expression;
use crate::mistake::{Fault, Mistake, Place};
use crate::names::{self, PI, TIME};
use crate::order::in_order;
use crate::parser::MAX_BYTES;
use crate::symbol::Symbol;

/// Components that a system can have at the most.
pub const MAX_COMPONENTS: usize = 16;

/// Subexpressions and parameters that a system can have at the most, of each.
pub const MAX_NAMES: usize = 256;

/// What formulas are the equations of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Rates of change, dx/dt = F(x). Every component has an equation.
    #[default]
    Flow,
    /// The next state, x' = F(x). Every component has an equation.
    Map,
    /// What a node sends, H(x). Components without a formula send nothing; there is no time.
    Coupling,
}

/// Equations as they are written.
#[derive(Clone, Debug, Default)]
pub struct Description<'a> {
    /// What they are the equations of.
    pub kind: Kind,
    /// Names of the components, in order.
    pub components: Vec<&'a str>,
    /// The formula of each component, in any order.
    pub equations: Vec<(&'a str, &'a str)>,
    /// Names for parts of formulas, in any order.
    pub subexpressions: Vec<(&'a str, &'a str)>,
    /// Parameters with their values.
    pub parameters: Vec<(&'a str, f64)>,
}

/// Something that is no mistake, but may be one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Warning {
    /// No formula uses it: a component that drives nothing, or a name that means nothing.
    Unused(Place),
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Unused(place) = self;
        write!(f, "{place}: nothing uses it")
    }
}

/// Equations that can be made a program.
#[derive(Clone, Debug)]
pub struct System {
    kind: Kind,
    components: Vec<String>,
    /// Component and formula, in the order of components.
    pub(crate) equations: Vec<(usize, Expression<Symbol>)>,
    /// Formulas of subexpressions.
    pub(crate) subexpressions: Vec<Expression<Symbol>>,
    /// Subexpressions in an order in which each comes after those it is made of.
    pub(crate) order: Vec<usize>,
    parameters: Vec<(String, f64)>,
    time: bool,
    warnings: Vec<Warning>,
}

impl System {
    /// Reads and resolves equations.
    ///
    /// # Errors
    /// The first [`Mistake`]: in names, then in what is written, then in what names mean.
    pub fn read(description: &Description<'_>) -> Result<Self, Mistake> {
        let meanings = Meanings::new(description)?;
        let equations = equations(description)?;
        check_length(description)?;
        let read = |place: Place, text: &str| {
            let placed = |fault, at| Mistake { place: place.clone(), at, fault };
            let expression =
                Expression::read(text).map_err(|mistake| placed(mistake.fault, mistake.at))?;
            let resolve = |name: &String, at: &Range<usize>| {
                meanings.of(name).map_err(|fault| placed(fault, Some(at.clone())))
            };
            expression.try_map(resolve)
        };
        let equations = equations
            .into_iter()
            .map(|(c, name, text)| Ok((c, read(Place::Equation(name.to_owned()), text)?)))
            .collect::<Result<Vec<_>, Mistake>>()?;
        let subexpressions = description
            .subexpressions
            .iter()
            .map(|(name, text)| read(Place::Subexpression((*name).to_owned()), text))
            .collect::<Result<Vec<_>, Mistake>>()?;
        let order = in_order(&subexpressions).map_err(|cycle| {
            let name = |&s: &usize| description.subexpressions[s].0.to_owned();
            let names: Vec<String> = cycle.iter().map(name).collect();
            let place = Place::Subexpression(names[0].clone());
            Mistake { place, at: None, fault: Fault::Cycle { names } }
        })?;
        let mut system = Self {
            kind: description.kind,
            components: description.components.iter().map(|&name| name.to_owned()).collect(),
            equations,
            subexpressions,
            order,
            parameters: description.parameters.iter().map(|&(n, v)| (n.to_owned(), v)).collect(),
            time: false,
            warnings: Vec::new(),
        };
        system.look_for_use(description)?;
        Ok(system)
    }

    /// What the formulas are the equations of.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Names of the components, in order.
    pub fn components(&self) -> impl Iterator<Item = &str> {
        self.components.iter().map(String::as_str)
    }

    /// Components that have a formula, in order.
    pub fn with_equation(&self) -> impl Iterator<Item = usize> {
        self.equations.iter().map(|(component, _)| *component)
    }

    /// Parameters with their values.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        self.parameters.iter().map(|(name, value)| (name.as_str(), *value))
    }

    /// Whether time enters: then it is one more component, behind the others.
    pub fn has_time(&self) -> bool {
        self.time
    }

    /// What may be a mistake.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Gives a parameter another value.
    ///
    /// # Errors
    /// A [`Mistake`] when there is none of that name, or when the value is not finite.
    pub fn set(&mut self, parameter: &str, value: f64) -> Result<(), Mistake> {
        let place = Place::Parameter(parameter.to_owned());
        let mistake = |fault| Err(Mistake { place, at: None, fault });
        if !value.is_finite() {
            return mistake(Fault::NotFinite { value });
        }
        let known = self.parameters.iter_mut().find(|(name, _)| name == parameter);
        if let Some((_, old)) = known {
            *old = value;
            return Ok(());
        }
        let known: Box<[String]> = self.parameters.iter().map(|(name, _)| name.clone()).collect();
        let nearest = names::nearest(parameter, known.iter().map(String::as_str));
        mistake(Fault::UnknownName { name: parameter.to_owned(), nearest, known })
    }

    /// Says what nothing uses, and whether time enters.
    fn look_for_use(&mut self, description: &Description<'_>) -> Result<(), Mistake> {
        let formulas =
            self.equations.iter().map(|(_, formula)| formula).chain(&self.subexpressions);
        let used: Vec<Symbol> = formulas.flat_map(Expression::names).copied().collect();
        self.time = used.contains(&Symbol::Time);
        if self.time && self.components.len() == MAX_COMPONENTS {
            let fault =
                Fault::TooManyComponents { found: MAX_COMPONENTS + 1, limit: MAX_COMPONENTS };
            return Err(Mistake { place: Place::System, at: None, fault });
        }
        let unused = |symbol: &Symbol| !used.contains(symbol);
        let components = description
            .components
            .iter()
            .enumerate()
            .map(|(c, name)| (Symbol::Component(c), Place::Component((*name).to_owned())));
        let subexpressions = description.subexpressions.iter().enumerate().map(|(s, (name, _))| {
            (Symbol::Subexpression(s), Place::Subexpression((*name).to_owned()))
        });
        let parameters = description
            .parameters
            .iter()
            .enumerate()
            .map(|(p, (name, _))| (Symbol::Parameter(p), Place::Parameter((*name).to_owned())));
        // Who reads a state for a coupling leaves components out on purpose.
        let components = components.filter(|_| self.kind != Kind::Coupling);
        self.warnings = components
            .chain(subexpressions)
            .chain(parameters)
            .filter(|(symbol, _)| unused(symbol))
            .map(|(_, place)| Warning::Unused(place))
            .collect();
        Ok(())
    }
}

/// What names mean.
struct Meanings<'a> {
    symbols: HashMap<&'a str, (Symbol, Place)>,
    kind: Kind,
}

impl<'a> Meanings<'a> {
    fn new(description: &Description<'a>) -> Result<Self, Mistake> {
        let Description { kind, components, subexpressions, parameters, .. } = description;
        let system = |fault| Err(Mistake { place: Place::System, at: None, fault });
        if components.is_empty() {
            return system(Fault::NoComponents);
        }
        if components.len() > MAX_COMPONENTS {
            let (found, limit) = (components.len(), MAX_COMPONENTS);
            return system(Fault::TooManyComponents { found, limit });
        }
        if let Some(found) = [subexpressions.len(), parameters.len()].into_iter().max()
            && found > MAX_NAMES
        {
            return system(Fault::TooManyNames { found, limit: MAX_NAMES });
        }
        let mut meanings = Self { symbols: HashMap::new(), kind: *kind };
        for (c, name) in components.iter().enumerate() {
            meanings.add(name, Symbol::Component(c), Place::Component((*name).to_owned()))?;
        }
        for (s, (name, _)) in subexpressions.iter().enumerate() {
            let place = Place::Subexpression((*name).to_owned());
            meanings.add(name, Symbol::Subexpression(s), place)?;
        }
        for (p, (name, value)) in parameters.iter().enumerate() {
            let place = Place::Parameter((*name).to_owned());
            if !value.is_finite() {
                return Err(Mistake { place, at: None, fault: Fault::NotFinite { value: *value } });
            }
            meanings.add(name, Symbol::Parameter(p), place)?;
        }
        Ok(meanings)
    }

    fn add(&mut self, name: &'a str, symbol: Symbol, place: Place) -> Result<(), Mistake> {
        let fault = if !names::is_name(name) {
            Fault::NoName
        } else if names::is_reserved(name) {
            Fault::Reserved
        } else if let Some((_, before)) = self.symbols.get(name) {
            Fault::Twice { before: before.clone() }
        } else {
            self.symbols.insert(name, (symbol, place));
            return Ok(());
        };
        Err(Mistake { place, at: None, fault })
    }

    fn of(&self, name: &str) -> Result<Symbol, Fault> {
        match name {
            PI => Ok(Symbol::Pi),
            TIME if self.kind == Kind::Coupling => Err(Fault::Time),
            TIME => Ok(Symbol::Time),
            _ => self.symbols.get(name).map(|(symbol, _)| *symbol).ok_or_else(|| {
                let mut known: Vec<&str> = self.symbols.keys().copied().collect();
                known.sort_unstable();
                let nearest = match name {
                    "π" | "Pi" | "PI" => Some(PI.to_owned()),
                    _ => names::nearest(name, known.iter().copied()),
                };
                let known = known.into_iter().map(ToOwned::to_owned).collect();
                Fault::UnknownName { name: name.to_owned(), nearest, known }
            }),
        }
    }
}

/// Refuses more text than is read, so that no program is too large.
fn check_length(description: &Description<'_>) -> Result<(), Mistake> {
    let Description { equations, subexpressions, .. } = description;
    let bytes = equations.iter().chain(subexpressions).map(|(_, text)| text.len()).sum();
    if bytes <= MAX_BYTES {
        return Ok(());
    }
    let fault = Fault::TooLong { bytes, limit: MAX_BYTES };
    Err(Mistake { place: Place::System, at: None, fault })
}

/// Component, name and text of every equation, in the order of components.
fn equations<'a>(description: &Description<'a>) -> Result<Vec<(usize, &'a str, &'a str)>, Mistake> {
    let Description { kind, components, equations, .. } = description;
    let mut texts: Vec<Option<&str>> = vec![None; components.len()];
    for &(name, text) in equations {
        let place = Place::Equation(name.to_owned());
        let mistake = |fault| Mistake { place: place.clone(), at: None, fault };
        let Some(c) = components.iter().position(|component| *component == name) else {
            let nearest = names::nearest(name, components.iter().copied());
            let known = components.iter().map(|&name| name.to_owned()).collect();
            return Err(mistake(Fault::NoComponent { nearest, known }));
        };
        if texts[c].replace(text).is_some() {
            return Err(mistake(Fault::Twice { before: place.clone() }));
        }
    }
    let mut found = Vec::new();
    for (c, (name, text)) in components.iter().zip(texts).enumerate() {
        match text {
            Some(text) => found.push((c, *name, text)),
            None if *kind == Kind::Coupling => {}
            None => {
                let place = Place::Component((*name).to_owned());
                return Err(Mistake { place, at: None, fault: Fault::NoEquation });
            }
        }
    }
    Ok(found)
}
