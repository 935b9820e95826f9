//! The file of a chart.

use std::path::Path;

use crate::failure::Failure;
use crate::output;

/// Whether the file of `--chart` can be written: charts are SVG.
pub(super) fn checked(path: &Path) -> Result<(), Failure> {
    let raster = ["png", "jpg", "jpeg", "pdf"];
    match path.extension().and_then(|e| e.to_str()).filter(|e| raster.iter().any(|r| e.eq_ignore_ascii_case(r))) {
        Some(ending) => Err(Failure::usage(format!(
            "--chart {}: found a name that ends with .{ending}, expected .svg: charts are SVG; convert them with rsvg-convert or a browser",
            path.display()
        ))),
        None => output::file("--chart", path),
    }
}
