//! Size of a function's machine code.

use std::path::Path;

use object::{Object, ObjectSymbol, SymbolKind};

/// The text symbols of a library and their sizes, bytes.
#[derive(Clone, Debug, Default)]
pub(super) struct Sizes(Vec<(String, u64)>);

impl Sizes {
    /// The symbols of the file; empty if it is unreadable.
    pub(super) fn of(library: &Path) -> Self {
        let Ok(bytes) = std::fs::read(library) else { return Self::default() };
        let Ok(file) = object::File::parse(&*bytes) else { return Self::default() };
        let text = file.symbols().filter(|s| s.kind() == SymbolKind::Text && s.size() > 0);
        Self(text.filter_map(|s| Some((s.name().ok()?.to_owned(), s.size()))).collect())
    }

    /// The bytes of the symbol and of everything that the compiler left outside it of the generated
    /// function of this name.
    pub(super) fn function(&self, name: &str, symbol: &str) -> Option<u64> {
        let own = self.0.iter().find(|(n, _)| n == symbol)?.1;
        // A mangled path holds each name with its length in front.
        let mut paths = ["", "_into"].map(|form| format!("5robot{}{name}{form}", name.len() + form.len())).to_vec();
        // The private module has the body and the loop over columns, if there is one.
        let inside = |item: &str| format!("5robot14implementation{}{item}", item.len());
        paths.extend([inside(name), inside("columns")]);
        // The pieces of C.
        let piece = format!("{symbol}_piece_");
        let outside = self.0.iter().filter(|(n, _)| paths.iter().any(|path| n.contains(path)) || n.starts_with(&piece));
        Some(own + outside.map(|(_, bytes)| bytes).sum::<u64>())
    }
}

#[cfg(test)]
mod tests {
    use super::Sizes;

    #[test]
    fn parts_of_a_function_count_with_it_and_others_do_not() {
        let symbol = |name: &str, bytes| (name.to_owned(), bytes);
        let sizes = Sizes(vec![
            symbol("articulated_placements", 100),
            symbol("_RNvNvNtNtCs1_9generated5robot14implementation10placements6part_0", 20),
            symbol("_RNvNtCs1_9generated5robot16inverse_dynamics", 3),
        ]);
        assert_eq!(sizes.function("placements", "articulated_placements"), Some(120));
        assert_eq!(sizes.function("bias_forces", "articulated_bias_forces"), None);
    }

    #[test]
    fn the_loop_over_columns_counts_with_the_function_that_ends_with_it() {
        let symbol = |name: &str, bytes| (name.to_owned(), bytes);
        let sizes = Sizes(vec![
            symbol("articulated_forward_dynamics_derivatives", 10),
            symbol("_RNvNtNtCs1_9generated5robot14implementation7columns7columns", 200),
        ]);
        assert_eq!(sizes.function("forward_dynamics_derivatives", "articulated_forward_dynamics_derivatives"), Some(210));
    }
}
