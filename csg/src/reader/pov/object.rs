//! Parses objects: a keyword, braces with components, and modifiers.

use super::super::error::SpannedError;
use super::super::lexer::{Lexeme, Token};
use super::super::spanned::Spanned;
use super::keywords::{self, FLAGS, NOT_OURS, REFUSED, SOLIDS, SURFACES};
use super::solid::{self, Object};
use super::{NO_MACROS, Reader, Value};
use crate::builder::SolidId;
use crate::tree::Operation;
use premio_text::escape::quote;

/// The maximum nesting depth of declared objects.
const MAX_INSIDE: usize = 100;

/// An object whose brace is still open.
struct Frame {
    /// Its keyword.
    word: Lexeme,
    kind: Kind,
    /// The operands read so far.
    children: Vec<Object>,
    /// The object itself, once all its components have been read.
    object: Option<Object>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Operation(Operation),
    /// One object, by its name or directly.
    Single,
}

impl Reader<'_> {
    /// Reads an object, starting after its keyword.
    pub(super) fn object(&mut self, first: Lexeme) -> Result<Object, SpannedError> {
        if self.inside == MAX_INSIDE {
            let found = "declarations of objects inside objects";
            let expected = format!("at most {MAX_INSIDE} of them");
            return Err(SpannedError::limit(first.span(), found, expected));
        }
        self.inside += 1;
        let mut frames = Vec::new();
        let mut done = self.begin(first, &mut frames)?;
        let object = loop {
            match (done.take(), frames.last_mut()) {
                (Some(object), None) => break object,
                (Some(object), Some(frame)) => frame.children.push(object),
                (None, _) => done = self.inner(&mut frames)?,
            }
        };
        self.inside -= 1;
        Ok(object)
    }

    /// Reads the start of an object; returns the object if it is complete.
    fn begin(
        &mut self,
        word: Lexeme,
        frames: &mut Vec<Frame>,
    ) -> Result<Option<Object>, SpannedError> {
        let text = self.cursor.text(word);
        if NOT_OURS.contains(&text) {
            self.pass_over_block(word)?;
            let found = format!("the object {}", quote(text));
            let expected = format!("one that is exact here: `{}`", SOLIDS.join("`, `"));
            return Ok(Some(
                SpannedError::input(word.span(), found, expected).into(),
            ));
        }
        self.cursor.expect('{', &format!("after `{text}`"))?;
        let mut frame = Frame {
            word,
            kind: Kind::Single,
            children: Vec::new(),
            object: None,
        };
        match text {
            "union" | "merge" => frame.kind = Kind::Operation(Operation::Union),
            "intersection" => frame.kind = Kind::Operation(Operation::Intersection),
            "difference" => frame.kind = Kind::Operation(Operation::Difference),
            _ => {
                let name = self.cursor.peek();
                let known = self.names.get(self.cursor.text(name));
                let begins = keywords::is_object(self.cursor.text(name));
                match known {
                    Some(Value::Object(object, _)) if name.token == Token::Name => {
                        frame.object = Some(object.clone());
                        self.cursor.next();
                    }
                    _ if text == "object" && begins => {}
                    _ if text == "object" => {
                        frame.object = Some(self.no_object(name)?.into());
                    }
                    _ => frame.object = Some(self.primitive(word)?),
                }
            }
        }
        frames.push(frame);
        Ok(None)
    }

    /// The error at a name that is not an object, to be reported where the name is used.
    fn no_object(&mut self, name: Lexeme) -> Result<SpannedError, SpannedError> {
        self.cursor.next();
        let text = self.cursor.text(name);
        if self.cursor.peek().is('(') {
            return Err(self.cursor.unexpected(name, "an object").help(NO_MACROS));
        }
        Ok(match self.names.get(text) {
            Some(Value::Refused(fault)) => SpannedError::clone(fault),
            Some(other) => {
                let found = format!("{}, which is {}", quote(text), other.describe());
                SpannedError::input(name.span(), found, "an object")
            }
            None => self.unknown(name),
        })
    }

    fn primitive(&mut self, word: Lexeme) -> Result<Object, SpannedError> {
        let text = self.cursor.text(word);
        let made = match text {
            "box" => {
                let a = self.vector()?.value;
                self.comma();
                let b = self.vector()?;
                solid::block(a, b.value, b.span)
            }
            "sphere" => {
                let middle = self.vector()?.value;
                self.comma();
                let radius = self.number()?;
                solid::sphere(&mut self.builder, middle, radius)
            }
            "plane" => {
                let Spanned {
                    value: normal,
                    span,
                } = self.vector()?;
                self.comma();
                let distance = self.number()?.value;
                solid::plane(&mut self.builder, normal, distance, &span)
            }
            "torus" => {
                let major = self.number()?.value;
                self.comma();
                let minor = self.number()?;
                solid::torus(&mut self.builder, major, minor)
            }
            _ => {
                let base = self.vector()?.value;
                self.comma();
                let first = if text == "cone" {
                    Some(self.number()?.value)
                } else {
                    None
                };
                self.comma();
                let top = self.vector()?.value;
                self.comma();
                let Spanned { value: last, span } = self.number()?;
                let radii = [first.unwrap_or_else(|| last.clone()), last];
                solid::cone(&mut self.builder, [base, top], radii, span)
            }
        };
        // An invalid length is reported where the object is used.
        Ok(made.unwrap_or_else(Object::from))
    }

    /// Reads the next item of the innermost object; returns the object if it is complete.
    fn inner(&mut self, frames: &mut Vec<Frame>) -> Result<Option<Object>, SpannedError> {
        let Some(frame) = frames.last_mut() else {
            return Ok(Some(SolidId::EMPTY.into()));
        };
        let lexeme = self.cursor.next();
        let text = self.cursor.text(lexeme);
        match lexeme.token {
            Token::End => Err(self.unclosed(lexeme, frame.word)),
            Token::Symbol('}') => {
                let object = self.made(frame);
                frames.pop();
                Ok(Some(object))
            }
            Token::Symbol('#') => self.directive().map(|()| None),
            Token::Name if frame.object.is_none() && keywords::is_object(text) => {
                let taken = frame.kind == Kind::Single && !frame.children.is_empty();
                match taken {
                    true => Err(self.cursor.unexpected(lexeme, "a modifier or `}`")),
                    false => self.begin(lexeme, frames),
                }
            }
            // A light source among solids is skipped.
            Token::Name if text == "light_source" => self.pass_over_block(lexeme).map(|()| None),
            Token::Name => {
                let object = self.made(frame);
                frame.object = Some(self.modified(object, lexeme)?);
                Ok(None)
            }
            _ => {
                let expected = "an object, a modifier or `}`";
                Err(self.cursor.unexpected(lexeme, expected))
            }
        }
    }

    /// The object of a frame, after all its components have been read.
    fn made(&mut self, frame: &mut Frame) -> Object {
        if let Some(object) = frame.object.take() {
            return object;
        }
        let children = std::mem::take(&mut frame.children);
        let op = match frame.kind {
            Kind::Operation(op) => op,
            Kind::Single => Operation::Union,
        };
        match (frame.kind, <[Object; 1]>::try_from(children)) {
            (Kind::Single, Ok([object])) => object,
            (_, Ok(one)) => solid::combined(&mut self.builder, op, one.into()),
            (_, Err(all)) => solid::combined(&mut self.builder, op, all),
        }
    }

    fn modified(&mut self, object: Object, word: Lexeme) -> Result<Object, SpannedError> {
        let text = self.cursor.text(word);
        match text {
            "translate" => {
                let by = self.vector()?.value;
                Ok(object.translated(&mut self.builder, by))
            }
            "rotate" => {
                let degrees = self.vector()?.value;
                Ok(object.rotated(&mut self.builder, degrees))
            }
            "scale" => {
                let Spanned { value: by, span } = self.vector()?;
                Ok(object.scaled(&mut self.builder, by, span))
            }
            "inverse" => {
                let is_inverse = self.switch().unwrap_or(true);
                Ok(match is_inverse {
                    true => object.inverse(&mut self.builder),
                    false => object,
                })
            }
            _ if SURFACES.contains(&text) => {
                self.pass_over_block(word)?;
                Ok(object)
            }
            _ if FLAGS.contains(&text) => {
                self.switch();
                Ok(object)
            }
            _ if REFUSED.contains(&text) => {
                self.pass_over_argument(text)?;
                let found = format!("the modifier {}", quote(text));
                let expected = "`translate`, `rotate`, or `scale` the same in all directions";
                Ok(SpannedError::input(word.span(), found, expected).into())
            }
            _ => {
                let known = ["translate", "rotate", "scale", "inverse"];
                let expected = "an object, a modifier or `}`";
                Err(self.cursor.unexpected(word, expected).suggest(text, known))
            }
        }
    }

    /// Skips the argument of a modifier that is refused.
    fn pass_over_argument(&mut self, modifier: &str) -> Result<(), SpannedError> {
        let next = self.cursor.peek();
        match (modifier, next.token) {
            (_, Token::Symbol('{')) => {
                let open = self.cursor.next();
                self.pass_over_to_end_of(open)
            }
            ("matrix", _) => self.expression().map(|_| ()),
            ("transform", _) => {
                self.cursor.next();
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// `on` or `off`, if it stands here.
    fn switch(&mut self) -> Option<bool> {
        let next = self.cursor.peek();
        let value = match next.token {
            Token::Name => keywords::truth(self.cursor.text(next)),
            Token::Number => Some(!self.cursor.text(next).trim_matches(['0', '.']).is_empty()),
            _ => None,
        };
        if value.is_some() {
            self.cursor.next();
        }
        value
    }
}
