//! Numbers as arrays, as text.

use crate::language::rust::statements::ZERO;

/// An array of zeros of these lengths.
pub(crate) fn zeros(lengths: &[usize]) -> String {
    lengths.iter().rev().fold(ZERO.to_owned(), |inner, n| format!("[{inner}; {n}]"))
}

/// Whether most of many values are zeros.
pub(crate) fn is_sparse(values: &[Option<String>]) -> bool {
    values.len() >= 64 && values.iter().filter(|value| value.is_none()).count() * 2 > values.len()
}

/// Values as an array of these lengths; `None` is zero.
pub(crate) fn nested(values: &[Option<String>], lengths: &[usize]) -> String {
    let text = |value: &Option<String>| value.clone().unwrap_or_else(|| ZERO.to_owned());
    match lengths {
        [] => values.first().map(text).unwrap_or_default(),
        [_] => format!("[{}]", values.iter().map(text).collect::<Vec<_>>().join(", ")),
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
    use crate::language::rust::statements::index;

    #[test]
    fn numbers_stand_row_by_row() {
        let values: Vec<Option<String>> = (0..24).map(|k| Some(k.to_string())).collect();
        let text: String = nested(&values, &[2, 3, 4]).split_whitespace().collect();
        assert_eq!(text, "[[[0,1,2,3],[4,5,6,7],[8,9,10,11]],[[12,13,14,15],[16,17,18,19],[20,21,22,23]]]");
        assert_eq!([index(0, &[2, 3, 4]), index(17, &[2, 3, 4]), index(7, &[8]), index(0, &[])], ["[0][0][0]", "[1][1][1]", "[7]", ""]);
        assert_eq!(zeros(&[2, 3]), "[[0.0; 3]; 2]");
        assert_eq!(nested(&values, &[]), "0");
    }
}
