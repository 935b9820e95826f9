//! A recording as comma-separated values: a row for each time.

use super::columns::Column;

/// The file's text. Every number reads back as the same double.
pub(super) fn text(columns: &[Column]) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|c| c.title.as_str()))?;
    let rows = columns.first().map_or(0, |c| c.values.len());
    for k in 0..rows {
        writer.write_record(columns.iter().map(|c| format!("{:?}", c.values[k])))?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::super::columns::{Column, columns};
    use super::super::recording::example;
    use super::text;
    use crate::robot::bundled_model;

    #[test]
    fn numbers_read_back_and_titles_are_quoted_where_they_must_be() {
        let column = |title: &str, values: [f64; 2]| Column { title: title.into(), unit: String::new(), values: values.into() };
        let written = text(&[column("t", [0.1 + 0.2, 1e-300]), column("q.a,b", [-0.0, 1e300])]).unwrap();
        assert_eq!(written, "t,\"q.a,b\"\n0.30000000000000004,-0.0\n1e-300,1e300\n");
    }

    #[test]
    fn every_number_reads_back_as_the_same_double() {
        let doubles = crate::states::exact::doubles();
        let written = text(&[Column { title: "t".into(), unit: String::new(), values: doubles.clone() }]).unwrap();
        let read: Vec<f64> = written.lines().skip(1).map(|line| line.parse().unwrap()).collect();
        assert!(read.len() == doubles.len() && read.iter().zip(&doubles).all(|(a, b)| a.to_bits() == b.to_bits()));
    }

    #[test]
    fn a_row_a_time_and_a_column_a_name() {
        let written = text(&columns(&example(&bundled_model("quadruped"), 5))).unwrap();
        let lines: Vec<&str> = written.lines().collect();
        assert_eq!(lines.len(), 6);
        assert!(lines[0].starts_with("t,q.__floating_base__[0],q.__floating_base__[1]"), "{}", lines[0]);
        assert!(lines.iter().all(|l| l.split(',').count() == 1 + 19 + 18 + 18 + 6 + 6));
    }
}
