//! Functions of robots in SQL: values, types, nulls and errors.

use std::sync::Arc;

use articulated::algorithm::{Function, functions};
use articulated::{Base, Dynamics, Model};
use articulated_datafusion::Robot;
use datafusion::arrow::array::{
    Array, ArrayRef, AsArray, BooleanArray, FixedSizeListArray, Float64Array, Int64Array, ListArray, NullArray, RecordBatch, StringArray,
    StructArray, new_null_array,
};
use datafusion::arrow::buffer::{NullBuffer, OffsetBuffer};
use datafusion::arrow::compute::{cast, concat_batches};
use datafusion::arrow::datatypes::{DataType, Field, Float64Type};
use datafusion::dataframe::DataFrameWriteOptions;
use datafusion::prelude::{ParquetReadOptions, SessionConfig, SessionContext};

articulated::robot! {
    pub mod arm {
        urdf = "../models/urdf/panda_like.urdf",
        functions = [inverse_dynamics, kinetic_energy, mass_matrix],
        batch = [f64],
    }
}

fn model(name: &str, base: Base) -> Model<f64> {
    articulated::load(format!("{}/../models/urdf/{name}.urdf", env!("CARGO_MANIFEST_DIR")), base).unwrap()
}

fn panda() -> Model<f64> {
    model("panda_like", Base::Fixed)
}

fn session(robot: Model<f64>) -> SessionContext {
    let context = SessionContext::new();
    Robot::new(robot).register(&context).unwrap();
    context
}

fn item(of: DataType) -> Arc<Field> {
    Arc::new(Field::new_list_field(of, true))
}

fn fixed(of: DataType, len: usize) -> DataType {
    DataType::FixedSizeList(item(of), len.try_into().unwrap())
}

/// Any numbers in ±0.5, others for each seed.
fn numbers(seed: usize, count: usize) -> Vec<f64> {
    (0..count).map(|i| ((i + 1) as f64 * (seed as f64 + 2.5).sqrt()).fract() - 0.5).collect()
}

fn column(numbers: Vec<f64>, len: usize) -> ArrayRef {
    let values = Arc::new(Float64Array::from(numbers));
    Arc::new(FixedSizeListArray::new(item(DataType::Float64), len.try_into().unwrap(), values, None))
}

/// A table with a column for each argument that functions of the robot take.
fn states(model: &Model<f64>, rows: usize) -> RecordBatch {
    use articulated::algorithm::Argument;
    let columns = Argument::ALL.into_iter().enumerate().map(|(seed, argument)| {
        let len = argument.len(model.shape());
        (argument.name(), column(numbers(seed, rows * len), len))
    });
    RecordBatch::try_from_iter(columns).unwrap()
}

async fn query(context: &SessionContext, sql: &str) -> Result<RecordBatch, String> {
    let run = async {
        let frame = context.sql(sql).await?;
        let schema = Arc::new(frame.schema().as_arrow().clone());
        let batches = frame.collect().await?;
        Ok(concat_batches(batches.first().map_or(&schema, |batch| batch.schema_ref()), &batches)?)
    };
    run.await.map_err(|error: datafusion::error::DataFusionError| error.strip_backtrace())
}

/// The numbers of a result; of a null row zeros or anything.
fn flat(array: &ArrayRef) -> Vec<f64> {
    match array.data_type() {
        DataType::Float64 => array.as_primitive::<Float64Type>().values().to_vec(),
        _ => array.as_fixed_size_list().values().as_primitive::<Float64Type>().values().to_vec(),
    }
}

fn call(function: &Function<f64>) -> String {
    let names: Vec<&str> = function.takes.iter().map(|argument| argument.name()).collect();
    format!("{}({})", function.name, names.join(", "))
}

/// What the library computes in each row.
fn expected(model: &Model<f64>, function: &Function<f64>, table: &RecordBatch) -> Vec<f64> {
    let (mut ws, len) = (model.workspace(), function.len(model.shape()));
    let mut out = vec![0.0; table.num_rows() * len];
    for (row, out) in out.chunks_exact_mut(len).enumerate() {
        let columns: Vec<Vec<f64>> = function
            .takes
            .iter()
            .map(|argument| flat(&table.column_by_name(argument.name()).unwrap().as_fixed_size_list().slice(row, 1).into_array()))
            .collect();
        let arguments: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        function.call(model, &mut ws, &arguments, out).unwrap();
    }
    out
}

trait IntoArray {
    fn into_array(self) -> ArrayRef;
}

impl<A: Array + 'static> IntoArray for A {
    fn into_array(self) -> ArrayRef {
        Arc::new(self)
    }
}

#[tokio::test]
async fn every_function_has_the_bits_of_the_library() {
    for (name, base) in [("panda_like", Base::Fixed), ("quadruped", Base::Floating), ("gripper_arm", Base::Fixed)] {
        let model = model(name, base);
        let (context, table) = (session(model.clone()), states(&model, 5));
        context.register_batch("states", table.clone()).unwrap();
        let mut count = 0;
        for function in functions::<f64>() {
            let found = query(&context, &format!("SELECT {} FROM states", call(function))).await;
            let found = match found {
                Err(error) if error.contains("expected six for each frame") || error.contains("singular") => continue,
                other => other.unwrap(),
            };
            let expected = expected(&model, function, &table);
            let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&flat(found.column(0))), bits(&expected), "{name}: {}", function.name);
            count += 1;
        }
        assert!(count >= 40, "{name}: {count}");
    }
}

#[tokio::test]
async fn a_generated_robot_gives_what_the_loaded_one_gives() {
    let context = session(panda());
    Robot::new(arm::Robot).prefixed("single").unwrap().register(&context).unwrap();
    let batched = Robot::new(arm::Robot)
        .with_batch("inverse_dynamics", arm::batch_f64::inverse_dynamics)
        .and_then(|robot| robot.with_batch("kinetic_energy", arm::batch_f64::kinetic_energy))
        .and_then(|robot| robot.with_batch("mass_matrix", arm::batch_f64::mass_matrix))
        .and_then(|robot| robot.prefixed("many"));
    batched.unwrap().register(&context).unwrap();
    context.register_batch("states", states(&panda(), 1003)).unwrap();
    for call in ["inverse_dynamics(q, v, a)", "kinetic_energy(q, v)", "mass_matrix(q)"] {
        let found = query(&context, &format!("SELECT {call}, single_{call}, many_{call} FROM states")).await.unwrap();
        let [library, single, many] = [0, 1, 2].map(|k| flat(found.column(k)));
        let size = library.iter().fold(0.0, |size: f64, x| size.max(x.abs()));
        for (library, (single, many)) in library.iter().zip(single.iter().zip(&many)) {
            assert!((library - single).abs() < 1e-13 * size && (library - many).abs() < 1e-13 * size, "{call}: {library} {single} {many}");
        }
    }
    // A constant is repeated for the functions of many states.
    let [zero, half] = [0.0, 0.5].map(|x| format!("{:?}", [x; 7]));
    let sql = format!("SELECT inverse_dynamics({half}, v, {zero}), many_inverse_dynamics({half}, v, {zero}) FROM states");
    let found = query(&context, &sql).await.unwrap();
    assert!(flat(found.column(0)).iter().zip(flat(found.column(1))).all(|(x, y)| (x - y).abs() < 1e-11));
    let error = query(&context, "SELECT single_placements(q) FROM states").await.unwrap_err();
    assert!(error.contains("single_placements: found a robot that was generated without this function"), "{error}");
}

#[tokio::test]
async fn any_list_of_numbers_is_an_argument() {
    let (model, context) = (panda(), session(panda()));
    let rows = 6;
    let halves: Vec<f64> = numbers(3, rows * 7).iter().map(|x| (x * 64.0).round() / 64.0).collect();
    let q = column(halves, 7);
    context.register_batch("plain", RecordBatch::try_from_iter([("q", q.clone())]).unwrap()).unwrap();
    let expected = flat(query(&context, "SELECT gravity_torque(q) FROM plain").await.unwrap().column(0));
    assert_eq!(expected.len(), rows * model.nv());
    for (k, to) in [
        DataType::List(item(DataType::Float64)),
        DataType::LargeList(item(DataType::Float64)),
        fixed(DataType::Float32, 7),
        DataType::List(item(DataType::Float32)),
        DataType::LargeList(item(DataType::Decimal128(20, 10))),
    ]
    .into_iter()
    .enumerate()
    {
        let table = format!("as{k}");
        let batch = RecordBatch::try_from_iter([("q", cast(&q, &to).unwrap())]).unwrap();
        context.register_batch(&table, batch).unwrap();
        let found = query(&context, &format!("SELECT gravity_torque(q) FROM {table}")).await.unwrap();
        assert_eq!(flat(found.column(0)), expected, "{to}");
        assert_eq!(found.column(0).data_type(), &fixed(DataType::Float64, 7));
        // A part of an array.
        let found = query(&context, &format!("SELECT gravity_torque(q) FROM {table} LIMIT 2 OFFSET 3")).await.unwrap();
        assert_eq!(flat(found.column(0)), expected[3 * 7..5 * 7], "{to}");
    }
    let found =
        query(&context, "SELECT gravity_torque([0, 1, 0, -1, 0, 1, 0]), gravity_torque(q => [0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0])").await;
    let found = found.unwrap();
    assert_eq!(flat(found.column(0)), flat(found.column(1)));
}

#[tokio::test]
async fn rows_with_a_null_are_null_and_nan_stays_in_its_row() {
    let context = session(panda());
    let mut values: Vec<Option<f64>> = numbers(4, 5 * 7).into_iter().map(Some).collect();
    values[7 + 3] = None;
    values[3 * 7 + 2] = Some(f64::NAN);
    let values = Arc::new(Float64Array::from(values));
    let nulls = NullBuffer::from(vec![true, true, false, true, true]);
    let q = FixedSizeListArray::new(item(DataType::Float64), 7, values.clone(), Some(nulls.clone()));
    // Of a variable list a null row may have no numbers.
    let lengths = OffsetBuffer::from_lengths([7, 7, 0, 7, 7]);
    let shorter = datafusion::arrow::compute::concat(&[&values.slice(0, 14), &values.slice(21, 14)]).unwrap();
    let list = ListArray::new(item(DataType::Float64), lengths, shorter, Some(nulls));
    let batch = RecordBatch::try_from_iter_with_nullable([("q", q.into_array(), true), ("list", list.into_array(), true)]).unwrap();
    context.register_batch("states", batch).unwrap();
    let sql = "SELECT gravity_torque(q), gravity_torque(list), potential_energy(q), mass_matrix(NULL), gravity_torque([NULL, 0, 0, 0, 0, 0, 0]), bias_forces(q, NULL) FROM states";
    let found = query(&context, sql).await.unwrap();
    for k in 0..3 {
        let nulls: Vec<bool> = (0..5).map(|row| found.column(k).is_null(row)).collect();
        assert_eq!(nulls, [false, true, true, false, false], "{k}");
    }
    assert!((3..6).all(|k| found.column(k).null_count() == 5));
    for k in 0..2 {
        let torques = found.column(k).as_fixed_size_list();
        let is_finite = |row: usize| torques.value(row).as_primitive::<Float64Type>().values().iter().all(|x| x.is_finite());
        assert_eq!([0, 3, 4].map(is_finite), [true, false, true], "{k}");
    }
}

#[tokio::test]
async fn parquet_is_read_with_and_without_the_schema_of_arrow() {
    let folder = std::env::temp_dir().join(format!("articulated-parquet-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let table = states(&panda(), 3000);
    let context = session(panda());
    context.register_batch("states", table.clone()).unwrap();
    let expected = query(&context, "SELECT inverse_dynamics(q, v, a) FROM states").await.unwrap();
    for without in [false, true] {
        let mut config = SessionConfig::new();
        config.options_mut().execution.parquet.skip_arrow_metadata = without;
        let writer = SessionContext::new_with_config(config);
        let file = folder.join(format!("{without}.parquet")).to_string_lossy().into_owned();
        let options = DataFrameWriteOptions::new().with_single_file_output(true);
        writer.read_batch(table.clone()).unwrap().write_parquet(&file, options, None).await.unwrap();
        let name = format!("log_{without}");
        let options = ParquetReadOptions::default().skip_metadata(without);
        context.register_parquet(&name, &file, options).await.unwrap();
        let frame = context.table(name.as_str()).await.unwrap();
        let is_fixed = matches!(frame.schema().field(0).data_type(), DataType::FixedSizeList(..));
        assert_eq!(is_fixed, !without, "{}", frame.schema());
        let found = query(&context, &format!("SELECT inverse_dynamics(q, v, a) FROM {name}")).await.unwrap();
        assert_eq!(flat(found.column(0)), flat(expected.column(0)), "{without}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[tokio::test]
async fn names_of_joints_and_frames_come_with_their_numbers() {
    let context = session(model("quadruped", Base::Floating));
    let found = query(&context, "SELECT unnest(joint_names()) AS joint, unnest(bias_forces(q, v)) AS h FROM (SELECT [0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] AS q, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0] AS v)").await.unwrap();
    let joints = found.column(0).as_string::<i32>();
    assert_eq!(found.num_rows(), 18);
    assert!(joints.value(0).ends_with("[0]") && joints.value(5).ends_with("[5]") && !joints.value(6).contains('['), "{joints:?}");
    let found = query(&context, "SELECT frame_names()").await.unwrap();
    assert!(found.column(0).as_list::<i32>().value_length(0) > 1);
}

#[tokio::test]
async fn a_table_without_rows_gives_none() {
    let context = session(panda());
    context.register_batch("states", states(&panda(), 3)).unwrap();
    let found = query(&context, "SELECT mass_matrix(q), kinetic_energy(q, v) FROM states WHERE q[1] > 100").await.unwrap();
    assert_eq!((found.num_rows(), found.column(0).data_type()), (0, &fixed(DataType::Float64, 49)));
}

#[tokio::test]
async fn functions_of_the_session_have_documentation() {
    let context = SessionContext::new_with_config(SessionConfig::new().with_information_schema(true));
    Robot::new(panda()).register(&context).unwrap();
    let sql = "SELECT syntax_example, description FROM information_schema.routines WHERE routine_name = 'mass_matrix'";
    let found = query(&context, sql).await.unwrap();
    let text = |k: usize| cast(found.column(k), &DataType::Utf8).unwrap().as_string::<i32>().value(0).to_owned();
    assert_eq!(text(0), "mass_matrix(q)");
    assert_eq!(text(1), "M(q). Gives (7, 7): kg·m²|kg·m|kg, symmetric.");
}

#[tokio::test]
async fn wrong_arguments_are_named() {
    let context = session(panda());
    let table = states(&panda(), 3);
    context.register_batch("states", table).unwrap();
    let ragged = ListArray::from_iter_primitive::<Float64Type, _, _>([Some(vec![Some(0.0); 7]), Some(vec![Some(0.0); 6])]);
    context.register_batch("ragged", RecordBatch::try_from_iter([("q", ragged.into_array())]).unwrap()).unwrap();
    for (sql, expected) in [
        ("inverse_dynamics(q, v) FROM states", "inverse_dynamics: found 2 arguments, expected 3: q, v, a"),
        ("mass_matrix() FROM states", "mass_matrix: found 0 arguments, expected 1: q"),
        (
            "inverse_dynamics(q, wrenches, 'text') FROM states",
            "inverse_dynamics: argument a: found Utf8, expected 7 numbers in each row: FixedSizeList<Float64>(7) or List<Float64>",
        ),
        ("gravity_torque(['a', 'b']) FROM states", "gravity_torque: argument q: found List<Utf8>, expected 7 numbers in each row"),
        ("mass_matrix(1.5)", "mass_matrix: argument q: found Float64, expected 7 numbers in each row"),
        ("mass_matrix([0.0, 1.0])", "mass_matrix: argument q: found 2 numbers, expected 7"),
        ("mass_matrix([])", "mass_matrix: argument q: found 0 numbers, expected 7"),
        ("mass_matrix(q) FROM ragged", "mass_matrix: argument q: found 6 numbers in row 1 of a batch of 2, expected 7"),
        ("mas_matrix(q) FROM states", "Did you mean 'mass_matrix'?"),
        ("joint_names(1)", "joint_names"),
    ] {
        let error = query(&context, &format!("SELECT {sql}")).await.unwrap_err();
        assert!(error.contains(expected), "{sql}: {error}");
    }
    // Both wrong arguments at once.
    let error = query(&context, "SELECT gravity_torque(q), bias_forces(target, 'text') FROM states").await.unwrap_err();
    assert!(error.contains("argument v: found Utf8"), "{error}");
}

#[tokio::test]
async fn a_function_that_the_robot_does_not_allow_says_why() {
    let urdf = r#"<robot name="r"><link name="base"/><link name="hand"/>
        <joint name="wrist" type="continuous"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/></joint></robot>"#;
    let massless = articulated::load_bytes("r.urdf", urdf.as_bytes(), Base::Fixed).unwrap();
    let context = session(massless);
    for (call, expected) in [
        ("forward_dynamics([0], [0], [0])", "forward_dynamics: found no inertia of its own for joint wrist, expected a link behind it"),
        ("center_of_mass([0])", "center_of_mass: found no moving link with mass, expected a link with mass that moves"),
    ] {
        let error = query(&context, &format!("SELECT {call}")).await.unwrap_err();
        assert!(error.contains(expected), "{error}");
    }
    let found = query(&context, "SELECT inverse_dynamics([0], [0], [0])").await.unwrap();
    assert_eq!(flat(found.column(0)), [0.0]);

    let error = query(&session(panda()), "SELECT operational_space_inertia([0, 0, 0, 0, 0, 0, 0])").await.unwrap_err();
    assert!(error.contains("operational_space_inertia: found fewer than six degrees of freedom for base_link, link_1, "), "{error}");
}

#[test]
fn a_robot_that_cannot_be_registered_says_why() {
    let context = session(panda());
    let error = Robot::new(panda()).register(&context).unwrap_err().strip_backtrace();
    assert!(error.contains("register: found functions placements, ") && error.contains("a prefix by `prefixed`"), "{error}");
    Robot::new(panda()).prefixed("left").unwrap().register(&context).unwrap();
    for prefix in ["", "Left", "1", "a b", "é", "a;b"] {
        let error = Robot::new(panda()).prefixed(prefix).unwrap_err().strip_backtrace();
        assert!(error.contains(&format!("prefix: found {prefix:?}, expected lower-case letters")), "{error}");
    }
    let body = articulated::load_bytes("r.urdf", b"<robot name='r'><link name='base'/></robot>", Base::Fixed).unwrap();
    let error = Robot::new(body).register(&SessionContext::new()).unwrap_err().strip_backtrace();
    assert!(error.contains("robot: found no degree of freedom, expected"), "{error}");
    assert!(Robot::load("/no/such/arm.urdf", Base::Fixed).unwrap_err().to_string().starts_with("/no/such/arm.urdf: "));

    let batch = arm::batch_f64::inverse_dynamics;
    let error = Robot::new(panda()).with_batch("inverse_dynamic", batch).unwrap_err().strip_backtrace();
    assert!(error.contains("with_batch: found the name \"inverse_dynamic\", expected one of placements, "), "{error}");
    let error = Robot::new(panda()).with_batch("bias_forces", batch).unwrap_err().strip_backtrace();
    assert!(error.contains("with_batch: bias_forces: found 3 arguments, expected 2: q, v"), "{error}");
    let error = Robot::new(model("ur5_like", Base::Fixed)).with_batch("inverse_dynamics", batch).unwrap_err().strip_backtrace();
    for name in ["q", "v", "a", "the result"] {
        assert!(error.contains(&format!("inverse_dynamics: {name}: found 7 numbers for each state, expected 6")), "{error}");
    }
}

#[tokio::test]
async fn a_batch_that_fails_is_an_error_of_the_query() {
    let fails = |_: &[[f64; 7]], _: &mut [f64]| Err("found no licence, expected one");
    let context = SessionContext::new();
    Robot::new(panda()).with_batch("potential_energy", fails).unwrap().register(&context).unwrap();
    let error = query(&context, "SELECT potential_energy([0, 0, 0, 0, 0, 0, 0])").await.unwrap_err();
    assert!(error.contains("potential_energy: found no licence, expected one"), "{error}");
}

/// Columns of any type give a result or an error.
#[tokio::test]
async fn no_column_ends_in_a_panic() {
    let context = session(panda());
    let rows = 3;
    let numbers = Arc::new(Float64Array::from(vec![f64::INFINITY; rows * 7]));
    let columns: Vec<ArrayRef> = vec![
        Arc::new(NullArray::new(rows)),
        Arc::new(BooleanArray::from(vec![true; rows])),
        Arc::new(Int64Array::from(vec![i64::MIN; rows])),
        Arc::new(StringArray::from(vec![""; rows])),
        Arc::new(FixedSizeListArray::new(item(DataType::Float64), 7, numbers, None)),
        Arc::new(StructArray::new_empty_fields(rows, None)),
        new_null_array(&fixed(DataType::Float64, 7), rows),
        new_null_array(&fixed(DataType::Float64, 0), rows),
        new_null_array(&fixed(DataType::Null, 7), rows),
        new_null_array(&fixed(fixed(DataType::Float64, 7), 7), rows),
        new_null_array(&DataType::List(item(DataType::Float64)), rows),
        new_null_array(&DataType::List(item(DataType::Utf8)), rows),
        new_null_array(&DataType::ListView(item(DataType::Float64)), rows),
        new_null_array(&DataType::LargeList(item(DataType::Int8)), rows),
        new_null_array(&DataType::Dictionary(Box::new(DataType::Int8), Box::new(DataType::Float64)), rows),
        new_null_array(&DataType::Duration(datafusion::arrow::datatypes::TimeUnit::Second), rows),
    ];
    let named = columns.iter().enumerate().map(|(k, column)| (format!("c{k}"), column.clone(), true));
    context.register_batch("odd", RecordBatch::try_from_iter_with_nullable(named).unwrap()).unwrap();
    let (mut results, mut errors) = (0, 0);
    for function in functions::<f64>() {
        for k in 0..columns.len() {
            let arguments = vec![format!("c{k}"); function.takes.len()].join(", ");
            match query(&context, &format!("SELECT {}({arguments}) FROM odd", function.name)).await {
                Ok(found) => results += usize::from(found.num_rows() == rows),
                Err(error) => {
                    assert!(error.contains(function.name) && error.contains("found") && error.contains("expected"), "{error}");
                    errors += 1;
                }
            }
        }
    }
    assert!(results > 100 && errors > 100, "{results} {errors}");
}
