//! Bodies of functions.

use std::fmt::Write;

use crate::Precision;
use crate::language::rust::function::signature::Signature;
use crate::language::rust::spills;
use crate::language::rust::statements::{FIELDS, Place, Printer, ty};
use crate::lir::function::Ending;
use crate::lir::{Body, Stmt, Ty};

/// Aligns the function's frame with a cache line. Otherwise vectors in the frame may cross lines,
/// depending on where the stack begins: a function takes up to a seventh longer.
const ALIGNED: &str = "    {
        // Vectors in this frame lie in one cache line each.
        #[repr(align(64))]
        #[allow(dead_code)]
        struct Line(u8);
        let _ = ::core::hint::black_box(&::core::mem::MaybeUninit::<Line>::uninit());
    }
";

/// The statement with which a body of vectors begins.
pub(crate) fn beginning(body: &Body) -> &'static str {
    if matches!(body.ty, Ty::Vector(_) | Ty::States) { ALIGNED } else { "" }
}

/// A body in one piece, the result last.
pub(crate) fn body(out: &mut String, body: &Body, signature: &Signature, level: Precision) {
    let [piece] = body.pieces.as_slice() else { return };
    let rooms = signature.rooms();
    let is_raw = signature.function.ending == Ending::Rows;
    if is_raw {
        for (name, place, length) in &rooms {
            let _ =
                writeln!(out, "    // SAFETY: the memory has room for so many numbers, and `MaybeUninit` allows that there are none yet.");
            let _ = writeln!(out, "    let {name} = unsafe {{ &mut *{place}.cast::<[::core::mem::MaybeUninit<f64>; {length}]>() }};");
        }
    }
    *out += beginning(body);
    let places = |at: usize| if is_raw { room(&rooms, at) } else { signature.place(at) };
    let printer = Printer { body, arguments: &signature.function.arguments, level, places: &places, is_raw };
    barrier(out, body, signature.nests());
    if let Some(slots) = &body.slots {
        spills::beginning(out, slots, ty(body.ty).0);
    }
    printer.statements(out, piece);
    let mut values: Vec<Option<String>> = Vec::new();
    for statement in piece {
        if let Stmt::Result(_, number) = statement {
            values.push((!number.is_zero()).then(|| printer.number(number)));
        }
    }
    if matches!(signature.function.ending, Ending::Value | Ending::Written) {
        signature.result(out, &values);
    }
    *out += if body.slots.is_some() { spills::END } else { "" };
}

/// The array of a number that is written to memory without values, and its place there.
fn room(rooms: &[(String, String, usize)], mut at: usize) -> Place {
    for (name, _, length) in rooms {
        if at < *length {
            return Place { array: name.clone(), index: Some(at) };
        }
        at -= length;
    }
    Place { array: String::new(), index: None }
}

/// The two pointers to one result, if it is stored through them.
fn barrier(out: &mut String, body: &Body, nests: Option<usize>) {
    if !body.barrier || !body.pieces.iter().flatten().any(|s| matches!(s, Stmt::Store(_))) {
        return;
    }
    barrier_pointers(out, body.results.iter().map(crate::lir::Array::numbers).sum(), nests.unwrap_or(0));
}

fn barrier_pointers(out: &mut String, numbers: usize, nests: usize) {
    let slice = if nests == 0 { ".as_mut_slice()".to_owned() } else { ".as_flattened_mut()".repeat(nests) };
    let _ = writeln!(
        out,
        "    let ::core::option::Option::Some(even) = ::core::cell::Cell::from_mut(out{slice}).as_slice_of_cells().first_chunk::<{numbers}>() else {{ ::core::unreachable!() }};\n    \
         // The same pointer, hidden from the compiler: it would look for vectors, which takes long and gains nothing.\n    \
         let odd = ::core::hint::black_box(even);\n    \
         let _ = (even, odd);"
    );
}

/// The pieces as functions `piece_0`, …, each for the features that the macro around it is given,
/// and `whole`, which calls them. They see arrays of arrays as one array: compilers take long to
/// check further indices.
pub(crate) fn pieces(out: &mut String, body: &Body, signature: &Signature, level: Precision) {
    let is_flat = signature.nests().is_some();
    let gives = if is_flat { signature.gives_flat() } else { signature.gives_inside() };
    let places = |at: usize| if is_flat { Place { array: "out".into(), index: Some(at) } } else { signature.place(at) };
    let printer = Printer { body, arguments: &signature.function.arguments, level, places: &places, is_raw: false };
    kept_types(out, "Kept", body);
    for (c, piece) in body.pieces.iter().enumerate() {
        let _ = writeln!(out, "    $(#[$features])?\n    #[inline(never)]");
        let _ = writeln!(out, "    fn piece_{c}({}) {{", signature.arguments_and(&format!("m: &mut Kept, out: &mut {gives}")));
        for argument in &signature.function.arguments {
            let _ = writeln!(out, "    let _ = {};", argument.name);
        }
        *out += "    let _ = (&m, &out);\n";
        *out += beginning(body);
        if body.barrier && piece.iter().any(|s| matches!(s, Stmt::Store(_))) {
            barrier_pointers(out, body.results.iter().map(crate::lir::Array::numbers).sum(), 0);
        }
        printer.statements(out, piece);
        *out += "    }\n";
    }
    let _ = writeln!(out, "    $(#[$features])?\n    fn whole({}){} {{", signature.takes(), signature.returns());
    *out += &nothing_kept("Kept", body);
    calls(out, signature, body.pieces.len());
    *out += "    }\n";
}

/// The calls of all pieces, and the result if it is a value.
fn calls(out: &mut String, signature: &Signature, pieces: usize) {
    let filled = signature.function.ending == Ending::Filled;
    if !filled {
        let _ = writeln!(out, "    let mut out = {};", signature.nothing_inside());
    }
    let place = if let Some(nests) = signature.nests() {
        let all = format!("out{}.first_chunk_mut()", ".as_flattened_mut()".repeat(nests));
        let _ = writeln!(out, "    let ::core::option::Option::Some(flat) = {all} else {{ ::core::unreachable!() }};");
        "flat"
    } else if filled {
        "out"
    } else {
        "&mut out"
    };
    for c in 0..pieces {
        let _ = writeln!(out, "    piece_{c}({});", signature.names_and(&format!("&mut m, {place}")));
    }
    *out += if filled { "" } else { "    out\n" };
}

/// The slots of each struct in `m`: which one, and how many.
fn structs(slots: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..slots.div_ceil(FIELDS)).map(move |k| (k, FIELDS.min(slots - k * FIELDS)))
}

/// The type of the values passed between pieces.
pub(crate) fn kept_types(out: &mut String, name: &str, body: &Body) {
    let ty = ty(body.ty).0;
    let mut declare = |name: &str, fields: Vec<String>| {
        let _ = writeln!(out, "    #[allow(dead_code, non_camel_case_types)]\n    struct {name} {{ {} }}", fields.join(", "));
    };
    declare(name, structs(body.kept).map(|(k, _)| format!("k{k}: {name}_{k}")).collect());
    structs(body.kept).for_each(|(k, fields)| declare(&format!("{name}_{k}"), (0..fields).map(|m| format!("m{m}: {ty}")).collect()));
}

/// The statements that make a value of this type.
pub(crate) fn nothing_kept(name: &str, body: &Body) -> String {
    let of = |(k, fields)| {
        let zeros: Vec<String> = (0..fields).map(|m| format!("m{m}: zero")).collect();
        format!("k{k}: {name}_{k} {{ {} }}", zeros.join(", "))
    };
    let all: Vec<String> = structs(body.kept).map(of).collect();
    format!("    let zero = {};\n    let mut m = {name} {{ {} }};\n", ty(body.ty).1, all.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::rust::statements::kept;

    #[test]
    fn every_slot_is_a_field_and_no_struct_is_long() {
        for slots in [1, FIELDS, FIELDS + 1, 3 * FIELDS - 1] {
            let all: Vec<String> = structs(slots).flat_map(|(k, fields)| (0..fields).map(move |m| format!("m.k{k}.m{m}"))).collect();
            assert_eq!(all, (0..slots).map(kept).collect::<Vec<_>>());
            assert!(structs(slots).all(|(_, fields)| fields <= FIELDS));
        }
    }
}
