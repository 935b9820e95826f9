//! For tests: doubles that are hard to read and to write, and their spellings.

/// Number of random doubles per format.
const COUNT: usize = 100_000;

/// Finite doubles: every second one of any size, subnormal too; the others of sizes that robots
/// have.
pub fn doubles() -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        state.wrapping_mul(0x2545_f491_4f6c_dd1d)
    };
    let mut all = Vec::with_capacity(COUNT);
    while all.len() < COUNT {
        let (any, part) = (f64::from_bits(next()), (next() >> 11) as f64 / (1_u64 << 53) as f64);
        let usual = (part - 0.5) * 10.0_f64.powi((next() % 21) as i32 - 10);
        all.extend(if all.len() % 2 == 0 && any.is_finite() { [any] } else { [usual] });
    }
    all
}

/// Both usual spellings that hold a double: the shortest, and 17 digits.
pub fn spellings(x: f64) -> [String; 2] {
    [format!("{x:?}"), format!("{x:.16e}")]
}

/// Every number of every format that is read is the double nearest to its spelling.
#[cfg(test)]
mod tests {
    use articulated_core::algorithm::Argument;

    use super::super::read;
    use super::{doubles, spellings};
    use crate::robot::bundled_model;

    fn same(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        let wrong = found.iter().zip(expected).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        assert_eq!(wrong, 0, "of {} numbers", expected.len());
    }

    /// The rates of all states in a text for a cart and pole, concatenated.
    fn rates(text: &str) -> Vec<f64> {
        let states = read(text.as_bytes(), &bundled_model("cart_pole")).unwrap().states;
        states.iter().flat_map(|state| state.get(Argument::V).unwrap().to_vec()).collect()
    }

    #[test]
    fn json_is_read_to_the_nearest_double() {
        let doubles = doubles();
        for form in [0, 1] {
            let rows: Vec<String> =
                doubles.chunks(2).map(|pair| format!("{{\"v\":[{},{}]}}", spellings(pair[0])[form], spellings(pair[1])[form])).collect();
            same(&rates(&format!("[{}]", rows.join(","))), &doubles);
        }
        // As the command itself writes it, and an integer of more digits than a double has.
        let pairs: Vec<serde_json::Value> = doubles.chunks(2).map(|pair| serde_json::json!({ "v": pair })).collect();
        same(&rates(&serde_json::to_string(&pairs).unwrap()), &doubles);
        same(
            &rates("[{\"v\":[9007199254740993,123456789012345678901234567890]}]"),
            &[9007199254740992.0, 123456789012345678901234567890.0],
        );
    }

    #[test]
    fn csv_is_read_to_the_nearest_double() {
        let (doubles, model) = (doubles(), bundled_model("cart_pole"));
        for form in [0, 1] {
            let mut text = format!("v.{},v.{}\n", model.joints()[0].name, model.joints()[1].name);
            doubles.chunks(2).for_each(|pair| text += &format!("{},{}\n", spellings(pair[0])[form], spellings(pair[1])[form]));
            same(&rates(&text), &doubles);
        }
    }
}
