//! Reads a formula: operators by how strongly they bind, each part with its place.
//!
//! From the loosest: `or`, `and`, `not`, comparisons, + and −, * and /, the sign −, and ^, which
//! groups from the right and takes a sign in its exponent: −x^2 is −(x^2), and 2^−x is 2^(−x).
//!
//! Source of the method: V. R. Pratt, Top down operator precedence, POPL (1973).

use std::ops::Range;

use crate::expression::{Expression, Index, Node, Part};
use crate::mistake::{Fault, Mistake, Place, shown};
use crate::names::{self, Binary, Comparison, Function};
use crate::token::{Kind, Token, tokens};

/// The longest formula that is read, and the longest of all of a system together, in bytes.
pub const MAX_BYTES: usize = 1 << 16;

/// How deep parentheses, signs, powers and functions may be nested.
pub const MAX_DEPTH: usize = 128;

type Read<T> = Result<T, (Range<usize>, Fault)>;

/// What stands between two parts of a formula.
#[derive(Clone, Copy)]
enum Operator {
    Or,
    And,
    Compare(Comparison),
    Arithmetic(Binary),
}

/// How strongly signs bind that stand before a part.
const NOT: u8 = 3;
const SIGN: u8 = 7;

impl Operator {
    /// How strongly it binds.
    fn strength(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Compare(_) => 4,
            Self::Arithmetic(Binary::Add | Binary::Subtract) => 5,
            Self::Arithmetic(Binary::Power) => 8,
            Self::Arithmetic(_) => 6,
        }
    }

    /// How strongly what stands on its right has to bind.
    fn right(self) -> u8 {
        match self {
            Self::Arithmetic(Binary::Power) => SIGN,
            other => other.strength() + 1,
        }
    }
}

impl Expression {
    /// Reads a formula.
    ///
    /// # Errors
    /// The first [`Mistake`], with its place.
    pub fn read(text: &str) -> Result<Self, Mistake> {
        let read = read(text);
        read.map_err(|(at, fault)| Mistake { place: Place::Formula, at: Some(at), fault })
    }
}

fn read(text: &str) -> Read<Expression> {
    if text.len() > MAX_BYTES {
        let fault = Fault::TooLong { bytes: text.len(), limit: MAX_BYTES };
        return Err((0..0, fault));
    }
    let tokens = tokens(text)?;
    if tokens.len() == 1 {
        return Err((0..text.len(), Fault::Empty));
    }
    let mut parser = Parser { text, tokens, next: 0, depth: 0, parts: Vec::new() };
    let whole = parser.expression(0)?;
    parser.at_end()?;
    parser.number(whole)?;
    Ok(Expression { parts: parser.parts })
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    next: usize,
    depth: usize,
    parts: Vec<Part>,
}

impl Parser<'_> {
    fn expression(&mut self, strength: u8) -> Read<Index> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err((self.peek().at.clone(), Fault::TooDeep { limit: MAX_DEPTH }));
        }
        let mut left = self.prefix()?;
        while let Some(operator) = self.operator().filter(|o| o.strength() >= strength) {
            if let Operator::Compare(_) = operator
                && self.parts[left].node.is_condition()
            {
                return Err((self.peek().at.clone(), Fault::Chained));
            }
            self.next += 1;
            let right = self.expression(operator.right())?;
            left = self.join(operator, left, right)?;
        }
        self.depth -= 1;
        Ok(left)
    }

    /// A part with its signs before it.
    fn prefix(&mut self) -> Read<Index> {
        let Token { kind, at } = self.take();
        match kind {
            Kind::Number(value) => Ok(self.push(Node::Number(value), at)),
            Kind::Minus => {
                let operand = self.expression(SIGN)?;
                let operand = self.number(operand)?;
                let at = at.start..self.parts[operand].at.end;
                Ok(self.push(Node::Negate(operand), at))
            }
            // A sign that changes nothing.
            Kind::Plus => {
                let operand = self.expression(SIGN)?;
                self.number(operand)
            }
            Kind::Open => {
                let inner = self.expression(0)?;
                let end = self.close(at.start)?;
                self.parts[inner].at = at.start..end;
                Ok(inner)
            }
            Kind::Name => self.named(at),
            _ => Err(self.expected(kind, at, "a number, a name or a parenthesis")),
        }
    }

    /// A name, a function with its arguments, or `not`.
    fn named(&mut self, at: Range<usize>) -> Read<Index> {
        let name = &self.text[at.clone()];
        if name == "not" {
            let operand = self.expression(NOT)?;
            let operand = self.condition(operand)?;
            let at = at.start..self.parts[operand].at.end;
            return Ok(self.push(Node::Not(operand), at));
        }
        if names::WORDS.contains(&name) {
            return Err(self.expected(Kind::Name, at, "a number, a name or a parenthesis"));
        }
        let called = self.peek().kind == Kind::Open;
        match names::function(name) {
            Some(function) if called => self.call(function, at),
            Some(_) => Err((at, Fault::NotCalled { function: name.to_owned() })),
            None if called => {
                let nearest = names::nearest(name, names::functions());
                Err((at, Fault::UnknownFunction { name: name.to_owned(), nearest }))
            }
            None => Ok(self.push(Node::Name(name.to_owned()), at)),
        }
    }

    fn call(&mut self, function: Function, at: Range<usize>) -> Read<Index> {
        let opened = self.take().at.start;
        let mut arguments = Vec::new();
        if self.peek().kind != Kind::Close {
            arguments.push(self.expression(0)?);
            while self.peek().kind == Kind::Comma {
                self.next += 1;
                arguments.push(self.expression(0)?);
            }
        }
        let whole = at.start..self.close(opened)?;
        let name = &self.text[at];
        let node = match (function, arguments.as_slice()) {
            (Function::Unary(function), &[a]) => Node::Unary(function, self.number(a)?),
            (Function::Binary(operation), &[a, b]) => {
                Node::Binary(operation, self.number(a)?, self.number(b)?)
            }
            (Function::If, &[condition, a, b]) => {
                Node::If(self.condition(condition)?, self.number(a)?, self.number(b)?)
            }
            (_, found) => {
                let expected = match function {
                    Function::Unary(_) => 1,
                    Function::Binary(_) => 2,
                    Function::If => 3,
                };
                let function = name.to_owned();
                return Err((whole, Fault::Arguments { function, found: found.len(), expected }));
            }
        };
        Ok(self.push(node, whole))
    }

    fn join(&mut self, operator: Operator, left: Index, right: Index) -> Read<Index> {
        let at = self.parts[left].at.start..self.parts[right].at.end;
        let node = match operator {
            Operator::Arithmetic(operation) => {
                Node::Binary(operation, self.number(left)?, self.number(right)?)
            }
            Operator::Compare(comparison) => {
                Node::Compare(comparison, self.number(left)?, self.number(right)?)
            }
            Operator::And => Node::And(self.condition(left)?, self.condition(right)?),
            Operator::Or => Node::Or(self.condition(left)?, self.condition(right)?),
        };
        Ok(self.push(node, at))
    }

    /// What the next token joins the part before it with.
    fn operator(&self) -> Option<Operator> {
        let token = self.peek();
        Some(match token.kind {
            Kind::Plus => Operator::Arithmetic(Binary::Add),
            Kind::Minus => Operator::Arithmetic(Binary::Subtract),
            Kind::Times => Operator::Arithmetic(Binary::Multiply),
            Kind::Over => Operator::Arithmetic(Binary::Divide),
            Kind::Power => Operator::Arithmetic(Binary::Power),
            Kind::Less => Operator::Compare(Comparison::Less),
            Kind::LessOrEqual => Operator::Compare(Comparison::LessOrEqual),
            Kind::Greater => Operator::Compare(Comparison::Greater),
            Kind::GreaterOrEqual => Operator::Compare(Comparison::GreaterOrEqual),
            Kind::Equal => Operator::Compare(Comparison::Equal),
            Kind::NotEqual => Operator::Compare(Comparison::NotEqual),
            Kind::Name if &self.text[token.at.clone()] == "and" => Operator::And,
            Kind::Name if &self.text[token.at.clone()] == "or" => Operator::Or,
            _ => return None,
        })
    }

    /// The end of a parenthesis that was opened there.
    fn close(&mut self, opened: usize) -> Read<usize> {
        let Token { kind, at } = self.peek().clone();
        match kind {
            Kind::Close => {
                self.next += 1;
                Ok(at.end)
            }
            Kind::End => Err((at, Fault::Unclosed { opened })),
            _ => Err(self.not_an_operator(kind, at)),
        }
    }

    fn at_end(&self) -> Read<()> {
        let Token { kind, at } = self.peek().clone();
        match kind {
            Kind::End => Ok(()),
            Kind::Close => Err((at, Fault::Unopened)),
            _ => Err(self.not_an_operator(kind, at)),
        }
    }

    /// What stands behind a part although it joins it with nothing.
    fn not_an_operator(&self, kind: Kind, at: Range<usize>) -> (Range<usize>, Fault) {
        match kind {
            Kind::Number(_) | Kind::Name | Kind::Open => {
                let found = self.quoted(kind, &at);
                (at, Fault::NoOperator { found })
            }
            Kind::Comma => {
                let digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
                let bytes = self.text.as_bytes();
                let before = at.start.checked_sub(1).and_then(|before| bytes.get(before));
                let decimal = digit(before) && digit(bytes.get(at.end));
                (at, Fault::Comma { decimal })
            }
            _ => self.expected(kind, at, "+, -, *, /, ^ or the end"),
        }
    }

    fn expected(
        &self,
        kind: Kind,
        at: Range<usize>,
        expected: &'static str,
    ) -> (Range<usize>, Fault) {
        let found = self.quoted(kind, &at);
        (at, Fault::Expected { found, expected })
    }

    fn quoted(&self, kind: Kind, at: &Range<usize>) -> String {
        match kind {
            Kind::End => "the end".into(),
            _ => format!("`{}`", shown(&self.text[at.clone()])),
        }
    }

    /// A part, if it is a number.
    fn number(&self, part: Index) -> Read<Index> {
        let Part { node, at } = &self.parts[part];
        if node.is_condition() { Err((at.clone(), Fault::Condition)) } else { Ok(part) }
    }

    /// A part, if it is true or false.
    fn condition(&self, part: Index) -> Read<Index> {
        let Part { node, at } = &self.parts[part];
        if node.is_condition() { Ok(part) } else { Err((at.clone(), Fault::Number)) }
    }

    fn push(&mut self, node: Node, at: Range<usize>) -> Index {
        self.parts.push(Part { node, at });
        self.parts.len() - 1
    }

    fn peek(&self) -> &Token {
        &self.tokens[self.next]
    }

    /// The next token; the end stays where it is.
    fn take(&mut self) -> Token {
        let token = self.peek().clone();
        if token.kind != Kind::End {
            self.next += 1;
        }
        token
    }
}
