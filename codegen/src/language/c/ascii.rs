//! Comments in ASCII: compilers for microcontrollers and old editors read a file in a code page.

/// The text with every character beyond ASCII spelled out: `τ` as `tau`, `M⁻¹` as `M^-1`, and
/// others by code point, as `<U+E9>`.
pub(super) fn ascii(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match SPELLED.iter().find(|(symbol, _)| *symbol == c) {
            _ if c.is_ascii() => out.push(c),
            Some((_, spelled)) => out += spelled,
            None => out += &format!("<U+{:X}>", u32::from(c)),
        }
    }
    out
}

const SPELLED: [(char, &str); 40] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "epsilon"),
    ('θ', "theta"),
    ('λ', "lambda"),
    ('μ', "mu"),
    ('π', "pi"),
    ('ρ', "rho"),
    ('τ', "tau"),
    ('φ', "phi"),
    ('ω', "omega"),
    ('Λ', "Lambda"),
    ('Σ', "sum"),
    ('∂', "d"),
    ('√', "sqrt"),
    // Dots over a letter, and letters that have one.
    ('\u{307}', "_dot"),
    ('\u{308}', "_ddot"),
    ('ṗ', "p_dot"),
    ('Ṁ', "M_dot"),
    ('⁻', "^-"),
    ('¹', "1"),
    ('½', "1/2"),
    ('‖', "||"),
    ('Ȧ', "A_dot"),
    ('²', "^2"),
    ('³', "^3"),
    ('ᵀ', "^T "),
    ('·', "*"),
    ('×', "x"),
    ('−', "-"),
    ('±', "+-"),
    ('≤', "<="),
    ('≥', ">="),
    ('→', "->"),
    ('⊕', "(+)"),
    ('⊖', "(-)"),
    ('°', "deg"),
    ('…', "..."),
];

#[cfg(test)]
mod tests {
    use articulated_core::algorithm::functions;

    use super::*;

    #[test]
    fn formulas_are_spelled_out() {
        assert_eq!(ascii("a = M(q)⁻¹·(τ + Σ Jᵀw − h), rad/s²"), "a = M(q)^-1*(tau + sum J^T w - h), rad/s^2");
        assert_eq!(ascii("[ω̇; p̈], [ω; ṗ]"), "[omega_dot; p_ddot], [omega; p_dot]");
        assert_eq!(ascii("\"bras gauche é\""), "\"bras gauche <U+E9>\"");
    }

    /// Only names of a robot's file have code points.
    #[test]
    fn every_symbol_of_the_table_of_functions_has_a_spelling() {
        for function in functions::<f64>() {
            let text = [function.summary, function.unit].join(" ") + &function.takes.iter().map(|a| a.unit()).collect::<String>();
            assert!(!ascii(&text).contains("<U+"), "{}: {}", function.name, ascii(&text));
        }
    }
}
