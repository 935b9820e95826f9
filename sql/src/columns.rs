//! Arguments of a call: Arrow columns as rows of numbers, checked.

use std::borrow::Cow;
use std::sync::Arc;

use datafusion::arrow::array::{Array, ArrayRef, AsArray, FixedSizeListArray, GenericListArray, OffsetSizeTrait};
use datafusion::arrow::buffer::{NullBuffer, ScalarBuffer};
use datafusion::arrow::compute::cast;
use datafusion::arrow::datatypes::{DataType, Field, Float64Type};
use datafusion::error::{DataFusionError, Result};
use datafusion::logical_expr::ColumnarValue;

/// A list of `len` items in each row.
pub(crate) fn list_type(item: DataType, len: usize) -> DataType {
    // A function with more numbers in a row is refused before it has a type.
    DataType::FixedSizeList(Arc::new(Field::new_list_field(item, true)), i32::try_from(len).unwrap_or(i32::MAX))
}

/// A type in few words, without names and metadata of fields.
fn shown(found: &DataType) -> String {
    match found {
        DataType::FixedSizeList(item, len) => format!("FixedSizeList<{}>({len})", shown(item.data_type())),
        DataType::List(item) => format!("List<{}>", shown(item.data_type())),
        DataType::LargeList(item) => format!("LargeList<{}>", shown(item.data_type())),
        other => other.to_string(),
    }
}

/// Whether values of this type can be numbers: of `Null` they are all null.
fn is_number(item: &Arc<Field>) -> bool {
    item.data_type().is_numeric() || item.data_type() == &DataType::Null
}

/// The type to which a column of this type is cast before a call. `None`: the column is no argument
/// of `len` numbers.
pub(crate) fn coerced(found: &DataType, len: usize) -> Option<DataType> {
    let numbers = || Arc::new(Field::new_list_field(DataType::Float64, true));
    match found {
        DataType::FixedSizeList(_, n) if usize::try_from(*n).ok() != Some(len) => None,
        DataType::FixedSizeList(item, _) | DataType::List(item) | DataType::LargeList(item) if item.data_type() == &DataType::Float64 => {
            Some(found.clone())
        }
        DataType::FixedSizeList(item, n) if is_number(item) => Some(DataType::FixedSizeList(numbers(), *n)),
        DataType::List(item) if is_number(item) => Some(DataType::List(numbers())),
        DataType::LargeList(item) if is_number(item) => Some(DataType::LargeList(numbers())),
        DataType::Null => Some(list_type(DataType::Float64, len)),
        _ => None,
    }
}

/// Why a column of this type is no argument of `len` numbers.
pub(crate) fn wrong_type(argument: &str, found: &DataType, len: usize) -> String {
    let found = shown(found);
    format!("argument {argument}: found {found}, expected {len} numbers in each row: FixedSizeList<Float64>({len}) or List<Float64>")
}

/// An argument of a call.
#[derive(Debug)]
pub(crate) struct Column {
    numbers: ScalarBuffer<f64>,
    /// Rows without a value.
    pub(crate) nulls: Option<NullBuffer>,
    /// Numbers of one row.
    len: usize,
    /// Whether there is one row, which is the same for all.
    is_constant: bool,
}

impl Column {
    /// Reads an argument of `len` numbers in each row.
    pub(crate) fn read(argument: &str, value: &ColumnarValue, len: usize) -> Result<Self> {
        let array = match value {
            ColumnarValue::Array(array) => Arc::clone(array),
            ColumnarValue::Scalar(scalar) => scalar.to_array()?,
        };
        let target = coerced(array.data_type(), len);
        let target = target.ok_or_else(|| DataFusionError::Execution(wrong_type(argument, array.data_type(), len)))?;
        let array = if array.data_type() == &target { array } else { cast(&array, &target)? };
        let is_constant = matches!(value, ColumnarValue::Scalar(_));
        let (numbers, nulls) = match array.data_type() {
            DataType::FixedSizeList(..) => fixed(array.as_fixed_size_list(), len),
            DataType::List(_) => variable::<i32>(argument, array.as_list(), len, is_constant)?,
            _ => variable::<i64>(argument, array.as_list(), len, is_constant)?,
        };
        Ok(Self { numbers, nulls, len, is_constant })
    }

    /// Numbers of a row.
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        let row = if self.is_constant { 0 } else { row };
        &self.numbers[row * self.len..][..self.len]
    }

    /// Numbers of so many rows. A row that is the same for all is repeated.
    pub(crate) fn rows(&self, count: usize) -> Cow<'_, [f64]> {
        if self.is_constant { self.numbers.repeat(count).into() } else { Cow::Borrowed(&self.numbers[..count * self.len]) }
    }

    /// Rows without a value, of so many.
    pub(crate) fn nulls_of(&self, count: usize) -> Option<NullBuffer> {
        let nulls = self.nulls.as_ref().filter(|nulls| nulls.null_count() > 0)?;
        Some(if self.is_constant { NullBuffer::new_null(count) } else { nulls.clone() })
    }
}

/// Rows that are null, and those that have a null among their numbers.
fn with_null_numbers(rows: Option<&NullBuffer>, numbers: &ArrayRef, len: usize) -> Option<NullBuffer> {
    let Some(nulls) = numbers.nulls().filter(|nulls| nulls.null_count() > 0) else { return rows.cloned() };
    let complete = (0..nulls.len() / len).map(|row| nulls.slice(row * len, len).null_count() == 0).collect();
    NullBuffer::union(rows, Some(&NullBuffer::new(complete)))
}

/// The numbers of a list with as many in each row, as they lie in memory.
fn fixed(list: &FixedSizeListArray, len: usize) -> (ScalarBuffer<f64>, Option<NullBuffer>) {
    let numbers = list.values().as_primitive::<Float64Type>().values().clone();
    (numbers, with_null_numbers(list.nulls(), list.values(), len))
}

/// The numbers of a list whose rows may differ, and here may not. Rows that follow one another in
/// memory are not copied.
fn variable<O: OffsetSizeTrait>(
    argument: &str,
    list: &GenericListArray<O>,
    len: usize,
    is_constant: bool,
) -> Result<(ScalarBuffer<f64>, Option<NullBuffer>)> {
    let (offsets, rows) = (list.value_offsets(), list.len());
    for row in (0..rows).filter(|row| list.is_valid(*row)) {
        let found = list.value_length(row).as_usize();
        if found != len {
            let place = if is_constant { String::new() } else { format!(" in row {row} of a batch of {rows}") };
            return Err(DataFusionError::Execution(format!("argument {argument}: found {found} numbers{place}, expected {len}")));
        }
    }
    let first = offsets[0].as_usize();
    if list.null_count() == 0 {
        let values = list.values().slice(first, rows * len);
        let nulls = with_null_numbers(None, &values, len);
        return Ok((values.as_primitive::<Float64Type>().values().clone(), nulls));
    }
    let values = list.values().as_primitive::<Float64Type>();
    let mut numbers = vec![0.0; rows * len];
    let mut is_complete = vec![false; rows];
    for (row, (numbers, is_complete)) in numbers.chunks_exact_mut(len).zip(&mut is_complete).enumerate() {
        if list.is_valid(row) {
            let start = offsets[row].as_usize();
            numbers.copy_from_slice(&values.values()[start..start + len]);
            *is_complete = values.nulls().is_none_or(|nulls| nulls.slice(start, len).null_count() == 0);
        }
    }
    Ok((numbers.into(), Some(NullBuffer::from(is_complete))))
}
