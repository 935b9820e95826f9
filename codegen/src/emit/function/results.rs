//! Numbers as arrays, as text.

/// As the emitter writes zero.
pub(crate) const ZERO: &str = "0.0";

/// An array of zeros of these lengths.
pub(crate) fn zeros(lengths: &[usize]) -> String {
    lengths.iter().rev().fold(ZERO.to_owned(), |inner, n| format!("[{inner}; {n}]"))
}

/// Whether most of many values are nothing.
pub(crate) fn is_sparse(values: &[String]) -> bool {
    values.len() >= 64 && values.iter().filter(|value| *value == ZERO).count() * 2 > values.len()
}

/// The indices of value `k` in an array of these lengths.
pub(crate) fn index(mut k: usize, lengths: &[usize]) -> String {
    lengths.iter().rev().fold(String::new(), |inner, n| {
        let own = format!("[{}]{inner}", k % n);
        k /= n;
        own
    })
}

/// Values as an array of these lengths.
pub(crate) fn nested(values: &[String], lengths: &[usize]) -> String {
    match lengths {
        [] => values.first().cloned().unwrap_or_default(),
        [_] => format!("[{}]", values.join(", ")),
        [n, inner @ ..] => {
            let width: usize = inner.iter().product();
            let rows: Vec<String> = (0..*n).map(|k| nested(&values[k * width..][..width], inner)).collect();
            format!("[{}]", rows.join(",\n     "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_row_by_row() {
        let values: Vec<String> = (0..24).map(|k| k.to_string()).collect();
        let text: String = nested(&values, &[2, 3, 4]).split_whitespace().collect();
        assert_eq!(text, "[[[0,1,2,3],[4,5,6,7],[8,9,10,11]],[[12,13,14,15],[16,17,18,19],[20,21,22,23]]]");
        assert_eq!([index(0, &[2, 3, 4]), index(17, &[2, 3, 4]), index(7, &[8]), index(0, &[])], ["[0][0][0]", "[1][1][1]", "[7]", ""]);
        assert_eq!(zeros(&[2, 3]), "[[0.0; 3]; 2]");
        assert_eq!(nested(&values, &[]), "0");
    }
}
