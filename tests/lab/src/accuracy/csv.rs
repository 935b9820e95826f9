//! The report as rows of numbers.

use super::report::{Point, Report, Spread};

const HEAD: &str = "function,level,peer,front,ns_median,ns_lower_quartile,ns_upper_quartile,error_median,error_99,error_largest,ulps_median,ulps_99,ulps_largest,rounding_largest,\
                    backward_largest,hard_largest,bound,reached,operations,instructions,code_bytes,compilation_seconds\n";

/// With a head.
pub(super) fn text(report: &Report) -> String {
    let rows = report.functions.iter().flat_map(|f| f.points.iter().map(|p| row(f.function, p)));
    HEAD.to_owned() + &rows.collect::<String>()
}

fn row(function: &str, p: &Point) -> String {
    let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:e}"));
    let count = |x: Option<u64>| x.map_or_else(String::new, |x| x.to_string());
    let three = |s: &Spread| [s.median, s.most, s.largest].map(|x| format!("{x:e}")).join(",");
    let largest = |s: Option<Spread>| number(s.map(|s| s.largest));
    let name = if p.level.contains([',', '"', '\n']) { format!("\"{}\"", p.level.replace('"', "\"\"")) } else { p.level.clone() };
    let t = &p.time;
    format!(
        "{function},{name},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
        p.peer,
        p.front,
        t.median,
        t.lower_quartile,
        t.upper_quartile,
        three(&p.relative),
        three(&p.ulps),
        largest(p.rounding),
        largest(p.backward),
        number(p.hard.map(|h| h.0)),
        number(p.bound),
        number(p.reached),
        count(p.operations),
        count(p.instructions),
        count(p.code_bytes),
        number(p.compilation_seconds)
    )
}

#[cfg(test)]
mod tests {
    use super::super::report::example;

    #[test]
    fn every_row_has_as_many_cells_as_the_head() {
        let text = super::text(&example());
        let cells: Vec<usize> = text.lines().map(|l| l.split(',').count()).collect();
        assert_eq!(cells, [cells[0]; 5]);
    }
}
