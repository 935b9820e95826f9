//! Spill slots in Rust.

use std::fmt::Write;

use crate::lir::Slots;
use crate::lir::function::Function;

/// Attributes of code for processors with sixteen registers, and of code for others.
pub(crate) const FEW_REGISTERS: &str = "#[cfg(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\")))]";
pub(crate) const MORE_REGISTERS: &str = "#[cfg(not(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\"))))]";

/// Whether a function has slots.
pub(crate) fn is_used(function: &Function) -> bool {
    function.few_registers.is_some() || function.states.as_ref().is_some_and(|states| states.few_registers.is_some())
}

/// The statements of a function that has both forms.
pub(crate) fn by_registers(few: &str, more: &str) -> String {
    format!("    {FEW_REGISTERS}\n    return {{\n{few}    }};\n    {MORE_REGISTERS}\n    return {{\n{more}    }};\n")
}

/// The module that the statements call.
pub(crate) const MODULE: &str = "\
/// Spill slots for 16-register x86-64.
#[cfg(all(target_arch = \"x86_64\", not(target_feature = \"avx512f\")))]
#[allow(unsafe_code, unused_results, clippy::all, clippy::pedantic)]
mod spills {
    /// Writes a spill slot. The write is volatile so that compilers do not look for pairs: that takes long, and gains nothing.
    #[inline(always)]
    pub(super) unsafe fn spill<T>(place: *mut T, x: T) {
        // SAFETY: the caller owns the slot.
        unsafe { place.write_volatile(x) }
    }
}

";

/// Text after the statements, and after the result made of them.
pub(crate) const END: &str = "    }\n";

/// The code before the statements: the slots, and pointers whose targets are hidden from compilers.
pub(crate) fn beginning(out: &mut String, slots: &Slots, ty: &str) {
    *out += "    // Explicit spill slots for 16-register x86-64.\n    use ::core::hint::black_box as hidden;\n";
    *out += "    use self::spills::spill;\n";
    if slots.far > 0 {
        room(out, ("far", "Far"), slots.far, "Far", ty);
        *out += "    let far = hidden(far.as_mut_ptr());\n";
    }
    let shelves = slots.near.div_ceil(slots.per_shelf);
    if shelves > 0 {
        room(out, ("shelves", "Shelf"), slots.per_shelf, &format!("[Shelf; {shelves}]"), ty);
        *out += "    let shelves: *mut Shelf = shelves.as_mut_ptr().cast();\n";
    }
    for k in (0..shelves).step_by(2) {
        // Of the second of two, which is where the first ends.
        let behind = (k + 1).min(shelves - 1);
        let _ = writeln!(out, "    let s{behind} = hidden(shelves.wrapping_add({behind}));");
        if behind > k {
            let _ = writeln!(out, "    let s{k} = s{behind}.wrapping_sub(1);");
        }
    }
    *out += "    // SAFETY: each slot is written before it is read.\n    unsafe {\n";
}

/// Memory for `made`, which consists of structs of this many slots.
fn room(out: &mut String, (name, place): (&str, &str), slots: usize, made: &str, ty: &str) {
    let fields: Vec<String> = (0..slots).map(|k| format!("m{k}: {ty}")).collect();
    let _ = writeln!(out, "    #[allow(dead_code)]\n    struct {place} {{ {} }}", fields.join(", "));
    let _ = writeln!(out, "    let mut {name} = ::core::mem::MaybeUninit::<{made}>::uninit();");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_shelves_lie_around_a_pointer() {
        let mut text = String::new();
        beginning(&mut text, &Slots { near: 25, per_shelf: 4, far: 0 }, "V");
        assert!(text.contains("struct Shelf { m0: V, m1: V, m2: V, m3: V }") && text.contains("MaybeUninit::<[Shelf; 7]>"), "{text}");
        assert!(text.contains("    let s5 = hidden(shelves.wrapping_add(5));\n    let s4 = s5.wrapping_sub(1);\n    let s6 = hidden(shelves.wrapping_add(6));\n"));
        assert!(!text.contains("far"), "{text}");
    }
}
