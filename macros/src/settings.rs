//! What the keys say.

use std::collections::BTreeSet;

use articulated_codegen::function_groups::{Group, MOTION};
use articulated_codegen::scene::articulated_scene::Node;
use articulated_codegen::{Base, Level, Options, Real, Reference, RobotOptions, Wanted};
use proc_macro2::Span;
use syn::{Error, Ident, LitStr, Path};

use crate::edits::{Load, Lock, Name, Other};
use crate::errors::Errors;
use crate::tree::Spans;

/// The values of the keys; `None` where a key is absent.
#[derive(Default)]
pub(crate) struct Settings {
    pub(crate) urdf: Option<LitStr>,
    pub(crate) scene: Option<LitStr>,
    pub(crate) effects: Option<Node>,
    /// Where the words of `effects` stand.
    pub(crate) spans: Spans,
    pub(crate) base: Option<Base>,
    pub(crate) gravity: Option<[f64; 3]>,
    pub(crate) functions: Option<Vec<Entry>>,
    pub(crate) parameters: Option<Vec<Entry>>,
    pub(crate) frames: Option<Vec<Name>>,
    pub(crate) wrench_reference: Option<Reference>,
    pub(crate) lock: Option<Vec<Lock>>,
    pub(crate) payloads: Option<Vec<Load>>,
    pub(crate) append: Option<Vec<Other>>,
    pub(crate) allow_unphysical_inertia: Option<bool>,
    pub(crate) snap_angles: Option<f64>,
    pub(crate) rename: Option<Vec<Renaming>>,
    pub(crate) limbs: Option<bool>,
    pub(crate) batch: Option<Vec<Real>>,
    pub(crate) level: Option<Level>,
    pub(crate) forbid_unsafe: Option<bool>,
    pub(crate) no_std: Option<bool>,
    pub(crate) runtime: Option<Path>,
    pub(crate) standalone: bool,
    /// What is wrong inside the tables.
    pub(crate) faults: Errors,
}

/// An entry of a list that the generator reads.
pub(crate) struct Entry {
    pub(crate) text: String,
    pub(crate) span: Span,
}

/// `"name in the URDF" = NAME_IN_RUST`; a name that is a word needs no quotation marks.
pub(crate) struct Renaming {
    pub(crate) from: Name,
    pub(crate) to: Ident,
}

impl Settings {
    /// What is wrong with the values, as far as can be told without the robot. What is wrong in a list is taken out.
    pub(crate) fn check(&mut self, errors: &mut Errors) {
        std::mem::take(&mut self.faults).into_error().into_iter().for_each(|fault| errors.push(fault));
        self.payloads.iter_mut().for_each(|loads| loads.retain(|load| load.payload().is_some()));
        self.append.iter_mut().for_each(|others| others.retain(|other| other.appended().is_some()));
        if let Some(functions) = &mut self.functions {
            let has_scene = self.scene.is_some();
            functions.retain(|entry| has_scene && entry.text.trim() == MOTION || errors.take(known(entry)).is_some());
        }
        let mut seen = BTreeSet::new();
        let renamings = self.rename.iter_mut();
        renamings.for_each(|all| all.retain(|renaming| errors.take(once(renaming, &mut seen)).is_some()));
        if let (true, Some(path)) = (self.standalone, &self.runtime) {
            errors.push(Error::new_spanned(path, "standalone code uses no crate: leave out `crate` or `standalone`"));
        }
    }

    /// The request's options: what is said, and `rest` where nothing is. Robots to append have no bytes yet.
    pub(crate) fn options(&self, rest: Options) -> Options {
        let renamed = |r: &Renaming| Some((r.from.text.clone(), r.to.to_string()));
        Options {
            robot: self.robot(rest.robot),
            functions: self.functions.as_ref().map_or(rest.functions, |entries| texts(entries)),
            motion: rest.motion,
            parameters: self.parameters.as_ref().map_or(rest.parameters, |entries| texts(entries)),
            rename: or(self.rename.as_ref(), renamed, rest.rename),
            limbs: self.limbs.unwrap_or(rest.limbs),
            batch: self.batch.clone().unwrap_or(rest.batch),
            level: self.level.unwrap_or(rest.level),
            forbid_unsafe: self.forbid_unsafe.unwrap_or(rest.forbid_unsafe),
            no_std: self.no_std.unwrap_or(rest.no_std),
            stages: false,
            runtime: (!self.standalone).then(|| self.runtime.as_ref().map_or("::articulated".into(), spelled)),
        }
    }

    fn robot(&self, rest: RobotOptions) -> RobotOptions {
        let names = |names: &Vec<Name>| names.iter().map(|name| name.text.clone()).collect();
        let locked = |lock: &Lock| Some((lock.joint.text.clone(), lock.at.clone()));
        RobotOptions {
            base: self.base.unwrap_or(rest.base),
            gravity: self.gravity.unwrap_or(rest.gravity),
            frames: self.frames.as_ref().map(names).or(rest.frames),
            wrench_reference: self.wrench_reference.unwrap_or(rest.wrench_reference),
            append: or(self.append.as_ref(), Other::appended, rest.append),
            payloads: or(self.payloads.as_ref(), Load::payload, rest.payloads),
            lock: or(self.lock.as_ref(), locked, rest.lock),
            allow_unphysical_inertia: self.allow_unphysical_inertia.unwrap_or(rest.allow_unphysical_inertia),
            snap_angles: self.snap_angles.or(rest.snap_angles),
            ..rest
        }
    }
}

/// What is said, be it nothing, in place of the rest.
fn or<T, U>(said: Option<&Vec<T>>, of: impl Fn(&T) -> Option<U>, rest: Vec<U>) -> Vec<U> {
    said.map_or(rest, |said| said.iter().filter_map(of).collect())
}

fn known(entry: &Entry) -> syn::Result<()> {
    if Group::named(entry.text.trim()).is_some() {
        return Ok(());
    }
    Wanted::parse(&entry.text).map(|_| ()).map_err(|error| Error::new(entry.span, error))
}

fn texts(entries: &[Entry]) -> Vec<String> {
    entries.iter().map(|e| e.text.clone()).collect()
}

fn once(renaming: &Renaming, seen: &mut BTreeSet<String>) -> syn::Result<()> {
    let name = renaming.from.text.clone();
    let twice = Error::new(renaming.from.span, format!("{name:?} is renamed twice"));
    if seen.insert(name) { Ok(()) } else { Err(twice) }
}

/// A path without spaces: `::articulated`.
fn spelled(path: &Path) -> String {
    let segments: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
    let colons = if path.leading_colon.is_some() { "::" } else { "" };
    format!("{colons}{}", segments.join("::"))
}
