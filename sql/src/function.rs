//! The functions as DataFusion calls them.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

use articulated::algorithm::{Dim, Function};
use datafusion::arrow::array::{Array, FixedSizeListArray, Float64Array};
use datafusion::arrow::buffer::NullBuffer;
use datafusion::arrow::datatypes::{DataType, Field};
use datafusion::common::ScalarValue;
use datafusion::error::{DataFusionError, Result};
use datafusion::logical_expr::{
    ColumnarValue, DocSection, Documentation, ScalarFunctionArgs, ScalarUDFImpl, Signature, TypeSignature, Volatility,
};

use crate::batch::Run;
use crate::columns::{Column, coerced, list_type, wrong_type};
use crate::evaluate::Evaluate;

/// The section of the functions in DataFusion's documentation.
const SECTION: DocSection = DocSection { include: true, label: "Robot dynamics", description: None };

/// A function of the table for one robot.
pub(crate) struct RobotFunction {
    name: String,
    robot: Arc<dyn Evaluate>,
    function: &'static Function<f64>,
    /// The function of many states, if there is one.
    batch: Option<Arc<Run>>,
    /// Why the function is not defined for the robot.
    refusal: Option<String>,
    /// Numbers of each argument in a row.
    lens: Vec<usize>,
    /// Numbers of a result in a row.
    len: usize,
    signature: Signature,
    documentation: Documentation,
}

/// Dimensions of one row, such as `(frames, 12)`.
fn dimensions(dims: &[Dim], robot: &dyn Evaluate) -> String {
    let dims: Vec<String> = dims.iter().map(|dim| dim.len(robot.shape()).to_string()).collect();
    if dims.is_empty() { "a number".into() } else { format!("({})", dims.join(", ")) }
}

impl RobotFunction {
    pub(crate) fn new(name: String, robot: &Arc<dyn Evaluate>, function: &'static Function<f64>, batch: Option<Arc<Run>>) -> Self {
        let shape = robot.shape();
        let names: Vec<&str> = function.takes.iter().map(|argument| argument.name()).collect();
        let lens: Vec<usize> = function.takes.iter().map(|argument| argument.len(shape)).collect();
        let len = function.len(shape);
        let fits = |len: &usize| (1..=i32::MAX as usize).contains(len);
        let refusal = match lens.iter().chain([&len]).find(|len| !fits(len)) {
            Some(len) => Some(format!("found {len} numbers in a row, expected 1 to {}", i32::MAX)),
            None if batch.is_some() => None,
            None => robot.refusal(function),
        };
        let text = format!("{}. Gives {}: {}.", function.summary, dimensions(function.gives, robot.as_ref()), function.unit);
        let mut documentation = Documentation::builder(SECTION, text, format!("{name}({})", names.join(", ")));
        for argument in function.takes {
            let text = format!("{}: {}", dimensions(argument.dims(), robot.as_ref()), argument.unit());
            documentation = documentation.with_argument(argument.name(), text);
        }
        let mut signature = Signature::user_defined(Volatility::Immutable);
        signature.parameter_names = Some(names.iter().map(ToString::to_string).collect());
        let (robot, documentation) = (Arc::clone(robot), documentation.build());
        Self { name, robot, function, batch, refusal, lens, len, signature, documentation }
    }

    fn names(&self) -> impl Iterator<Item = &'static str> {
        self.function.takes.iter().map(|argument| argument.name())
    }

    /// Why a call with so many arguments is none.
    fn refused(&self, arguments: usize) -> Option<String> {
        if let Some(refusal) = &self.refusal {
            return Some(format!("{}: {refusal}", self.name));
        }
        let expected: Vec<&str> = self.names().collect();
        let wrong = || format!("{}: found {arguments} arguments, expected {}: {}", self.name, expected.len(), expected.join(", "));
        (arguments != expected.len()).then(wrong)
    }

    fn result_type(&self) -> DataType {
        if self.function.gives.is_empty() { DataType::Float64 } else { list_type(DataType::Float64, self.len) }
    }

    /// Results of so many rows, one after the other.
    fn evaluate(&self, columns: &[Column], nulls: Option<&NullBuffer>, rows: usize) -> Result<Vec<f64>> {
        let mut out = Vec::new();
        let numbers = rows.checked_mul(self.len).filter(|numbers| out.try_reserve_exact(*numbers).is_ok());
        let numbers = numbers.ok_or_else(|| {
            let found = format!("{}: found no memory for {rows} rows of {} numbers", self.name, self.len);
            DataFusionError::ResourcesExhausted(format!("{found}, expected a smaller `datafusion.execution.batch_size`"))
        })?;
        out.resize(numbers, 0.0);
        if nulls.is_some_and(|nulls| nulls.null_count() == rows) {
            return Ok(out);
        }
        let failed = |error: String| DataFusionError::Execution(format!("{}: {error}", self.name));
        match &self.batch {
            Some(run) => {
                let arguments: Vec<_> = columns.iter().map(|column| column.rows(rows)).collect();
                let arguments: Vec<&[f64]> = arguments.iter().map(AsRef::as_ref).collect();
                run(&arguments, &mut out).map_err(failed)?;
            }
            None => self.robot.rows(self.function, columns, nulls, &mut out).map_err(|error| failed(error.to_string()))?,
        }
        Ok(out)
    }
}

impl fmt::Debug for RobotFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RobotFunction").field("name", &self.name).finish_non_exhaustive()
    }
}

impl PartialEq for RobotFunction {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.function.id == other.function.id && Arc::ptr_eq(&self.robot, &other.robot)
    }
}

impl Eq for RobotFunction {}

impl Hash for RobotFunction {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.name.hash(state);
    }
}

impl ScalarUDFImpl for RobotFunction {
    fn name(&self) -> &str {
        &self.name
    }

    fn signature(&self) -> &Signature {
        &self.signature
    }

    /// A wrong type stays as it is: `return_type` refuses it, in a message that DataFusion does not
    /// wrap.
    fn coerce_types(&self, found: &[DataType]) -> Result<Vec<DataType>> {
        if self.refused(found.len()).is_some() {
            return Ok(found.to_vec());
        }
        Ok(found.iter().zip(&self.lens).map(|(found, len)| coerced(found, *len).unwrap_or_else(|| found.clone())).collect())
    }

    fn return_type(&self, found: &[DataType]) -> Result<DataType> {
        if let Some(refusal) = self.refused(found.len()) {
            return Err(DataFusionError::Plan(refusal));
        }
        let arguments = self.names().zip(found).zip(&self.lens);
        let wrong: Vec<String> = arguments
            .filter(|((_, found), len)| coerced(found, **len).is_none())
            .map(|((name, found), len)| format!("{}: {}", self.name, wrong_type(name, found, *len)))
            .collect();
        if wrong.is_empty() { Ok(self.result_type()) } else { Err(DataFusionError::Plan(wrong.join("\n"))) }
    }

    fn invoke_with_args(&self, call: ScalarFunctionArgs) -> Result<ColumnarValue> {
        if let Some(refusal) = self.refused(call.args.len()) {
            return Err(DataFusionError::Execution(refusal));
        }
        let mut columns = Vec::with_capacity(self.lens.len());
        for ((name, value), len) in self.names().zip(&call.args).zip(&self.lens) {
            let named = |error| match error {
                DataFusionError::Execution(text) => DataFusionError::Execution(format!("{}: {text}", self.name)),
                other => other.context(format!("{}: argument {name}", self.name)),
            };
            columns.push(Column::read(name, value, *len).map_err(named)?);
        }
        let is_constant = call.args.iter().all(|value| matches!(value, ColumnarValue::Scalar(_)));
        let rows = if is_constant { 1 } else { call.number_rows };
        let nulls = columns
            .iter()
            .fold(None, |nulls: Option<NullBuffer>, column| NullBuffer::union(nulls.as_ref(), column.nulls_of(rows).as_ref()));
        let numbers = self.evaluate(&columns, nulls.as_ref(), rows)?;

        let array: Arc<dyn Array> = match self.result_type() {
            DataType::FixedSizeList(field, len) => {
                Arc::new(FixedSizeListArray::try_new(field, len, Arc::new(Float64Array::new(numbers.into(), None)), nulls)?)
            }
            _ => Arc::new(Float64Array::new(numbers.into(), nulls)),
        };
        if is_constant {
            return Ok(ColumnarValue::Scalar(ScalarValue::try_from_array(&array, 0)?));
        }
        Ok(ColumnarValue::Array(array))
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(&self.documentation)
    }
}

/// A function without arguments whose result is a list of names.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(crate) struct Names {
    name: String,
    names: Vec<String>,
    signature: Signature,
    documentation: Documentation,
}

impl Names {
    pub(crate) fn new(name: String, names: Vec<String>, text: &str) -> Self {
        let documentation = Documentation::builder(SECTION, text, format!("{name}()")).build();
        Self { name, names, signature: Signature::new(TypeSignature::Nullary, Volatility::Immutable), documentation }
    }
}

impl ScalarUDFImpl for Names {
    fn name(&self) -> &str {
        &self.name
    }

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn return_type(&self, _: &[DataType]) -> Result<DataType> {
        Ok(DataType::List(Arc::new(Field::new_list_field(DataType::Utf8, true))))
    }

    fn invoke_with_args(&self, _: ScalarFunctionArgs) -> Result<ColumnarValue> {
        let names: Vec<ScalarValue> = self.names.iter().map(|name| ScalarValue::from(name.as_str())).collect();
        Ok(ColumnarValue::Scalar(ScalarValue::List(ScalarValue::new_list(&names, &DataType::Utf8, true))))
    }

    fn documentation(&self) -> Option<&Documentation> {
        Some(&self.documentation)
    }
}
