//! The interface of CasADi's `external`: each function under its own name, with the sizes and the
//! sparsity of its arguments and results.
//!
//! A result of several dimensions is a matrix: the last dimension has its columns. CasADi's
//! matrices go column by column, ours row by row, so results are copied. Entries that are zero
//! at every configuration are left out.
//!
//! With derivatives of the first order a function f has `jac_f` and `adj1_f`, with those of the
//! second `jac_adj1_f` too: CasADi finds them by these names. They are by the numbers of q, of a
//! function in which each quaternion is divided by its length.

use std::fmt::Write;

use articulated_core::algorithm::{Argument, Group};

use crate::function_spec::{Derivative, FunctionSpec, Transform};
use crate::lir::function::Function;
use crate::lir::{Operand, Stmt, Store};

/// A matrix whose entries are somewhere in an array of ours.
#[derive(Clone)]
struct Matrix {
    rows: usize,
    columns: usize,
    /// Row, column and place in the array of each entry that is not always zero, column by column.
    entries: Vec<[usize; 3]>,
}

impl Matrix {
    /// The block of `rows` × `columns` numbers from `start` on, row by row.
    fn of(zeros: &[bool], start: usize, rows: usize, columns: usize) -> Self {
        let all = (0..columns).flat_map(|j| (0..rows).map(move |i| [i, j, start + i * columns + j]));
        Self { rows, columns, entries: all.filter(|[_, _, at]| !zeros[*at]).collect() }
    }

    /// A vector of this length, all of which may be non-zero.
    fn full(length: usize) -> Self {
        Self::of(&vec![false; length], 0, length, 1)
    }

    /// ∂R/∂x for a matrix R of `rows` × `columns` and a vector x of `length`, in an array from
    /// `start` on that has R row by row, and for each of its entries the derivatives.
    fn block(zeros: &[bool], start: usize, (rows, columns, length): (usize, usize, usize)) -> Self {
        let place = |i: usize, j: usize, k: usize| start + (i * columns + j) * length + k;
        let entry = |i: usize, j: usize, k: usize| [j * rows + i, k, place(i, j, k)];
        let all = (0..length).flat_map(|k| (0..columns).flat_map(move |j| (0..rows).map(move |i| (i, j, k))));
        let entries = all.map(|(i, j, k)| entry(i, j, k)).filter(|[.., at]| !zeros[*at]).collect();
        Self { rows: rows * columns, columns: length, entries }
    }

    /// The same for an array that begins elsewhere.
    fn moved(mut self, by: usize) -> Self {
        self.entries.iter_mut().for_each(|entry| entry[2] += by);
        self
    }

    fn transposed(&self) -> Self {
        let mut entries: Vec<[usize; 3]> = self.entries.iter().map(|[i, j, at]| [*j, *i, *at]).collect();
        entries.sort_unstable_by_key(|[i, j, _]| (*j, *i));
        Self { rows: self.columns, columns: self.rows, entries }
    }

    /// Whether it is an array of ours as it is.
    fn is_plain(&self) -> bool {
        self.is_dense() && self.entries.iter().enumerate().all(|(k, entry)| entry[2] == k)
    }

    fn is_dense(&self) -> bool {
        self.entries.len() == self.rows * self.columns
    }

    /// Rows, columns, where each column begins, and the row of each entry; a 1 in place of these
    /// two for a dense matrix.
    fn sparsity(&self) -> Vec<usize> {
        if self.is_dense() {
            return vec![self.rows, self.columns, 1];
        }
        let starts = (0..=self.columns).map(|j| self.entries.iter().filter(|entry| entry[1] < j).count());
        [self.rows, self.columns].into_iter().chain(starts).chain(self.entries.iter().map(|entry| entry[0])).collect()
    }
}

/// The functions of the interface, for all functions of the module; those that are derivatives of
/// another one are `jac_f`, `adj1_f` and `jac_adj1_f` of it.
pub(super) fn write(out: &mut String, prefix: &str, functions: &[Function]) {
    let _ = writeln!(out, "/* The interface of CasADi's external. */\n");
    let export = format!("{}_EXPORT", prefix.to_ascii_uppercase());
    let _ = writeln!(
        out,
        "#if defined(_WIN32)\n#define {export} __declspec(dllexport)\n#elif defined(__GNUC__)\n\
         #define {export} __attribute__((visibility(\"default\")))\n#else\n#define {export}\n#endif\n"
    );
    let named = |name: String| functions.iter().find(|f| f.spec.name == name);
    let is_derived = |f: &Function| {
        ORDERS.concat().iter().any(|(suffix, _)| {
            let of = f.spec.name.strip_suffix(suffix).map(|name| named(name.to_owned()));
            f.spec.transform.is_some() && matches!(of, Some(Some(_)))
        })
    };
    for function in functions.iter().filter(|f| !is_derived(f)) {
        let name = &function.spec.name;
        let [jacobian, adjoint, hessian] = [JACOBIAN, ADJOINT, HESSIAN].map(|suffix| named(format!("{name}{suffix}")));
        let own = Own { export: &export, prefix, function };
        own.value(out);
        if let Some(jacobian) = jacobian {
            own.jacobian(out, jacobian);
        }
        if let Some(adjoint) = adjoint {
            own.adjoint(out, adjoint);
        }
        if let (Some(jacobian), Some(hessian)) = (jacobian, hessian) {
            own.hessian(out, jacobian, hessian);
        }
    }
}

/// Whether a function would have the name of a derivative of another one.
pub(super) fn is_name_of_a_derivative(name: &str, of: &str) -> bool {
    let behind = name.strip_prefix(of).is_some_and(|rest| [JACOBIAN, ADJOINT, HESSIAN].contains(&rest));
    behind || name.strip_suffix(of).is_some_and(|rest| ["jac_", "adj1_", "jac_adj1_"].contains(&rest))
}

const JACOBIAN: &str = "_jacobian";
const ADJOINT: &str = "_adjoint";
const HESSIAN: &str = "_hessian";

/// The derivatives of each order, with the ends of their names.
const ORDERS: [&[(&str, Derivative)]; 2] =
    [&[(JACOBIAN, Derivative::Jacobian), (ADJOINT, Derivative::Vjp)], &[(HESSIAN, Derivative::Hessian)]];

/// A function with its derivatives up to an order, of functions other than sums, derivatives and
/// regressors. In coordinates, since CasADi knows no others; quaternions are divided by their
/// length. `names`: those of all functions.
pub(in crate::language) fn with_derivatives(function: &FunctionSpec, names: &[String], order: usize) -> Vec<FunctionSpec> {
    let mut all = vec![FunctionSpec { normalises: function.transform.is_none(), ..function.clone() }];
    if let ([part], None) = (function.parts.as_slice(), &function.transform)
        && !matches!(part.function.group, Group::Derivatives | Group::Regressors)
        && !part.sines
    {
        let wrt: Vec<Argument> = part.function.takes.iter().copied().filter(|a| part.constant(*a).is_none()).collect();
        for (suffix, kind) in ORDERS[..order.min(ORDERS.len())].concat() {
            let name = format!("{}{suffix}", function.name);
            let transform = Some(Transform { kind, wrt: wrt.clone(), in_coordinates: true });
            if !wrt.is_empty() && !names.contains(&name) {
                all.push(FunctionSpec { name, transform, normalises: false, ..function.clone() });
            }
        }
    }
    all
}

/// Names and lengths of the arguments.
fn inputs(function: &Function) -> Vec<Input> {
    let length = |a: &crate::lir::function::Argument| a.dims.iter().map(|d| d.len(function.shape)).product();
    function.arguments.iter().map(|a| Input { name: a.name.to_owned(), matrix: Matrix::full(length(a)) }).collect()
}

/// The results of a function as matrices, in the array that it writes.
fn results(function: &Function) -> Vec<(String, Matrix)> {
    let zeros = zeros(function);
    let (mut start, mut results) = (0, Vec::new());
    for (array, output) in function.results.iter().zip(&function.outputs) {
        let dims: Vec<usize> = output.dims.iter().map(|d| d.len(function.shape)).collect();
        let columns = if dims.len() > 1 { dims[dims.len() - 1] } else { 1 };
        let rows = if dims.len() > 1 { dims[..dims.len() - 1].iter().product() } else { array.numbers() };
        let name = if function.results.len() == 1 { "out" } else { output.name };
        results.push((name.to_owned(), Matrix::of(&zeros, start, rows, columns)));
        start += array.numbers();
    }
    results
}

/// How many numbers each result of a function has.
fn lengths(function: &Function) -> Vec<usize> {
    function.results.iter().map(|a| a.numbers()).collect()
}

/// A function whose value and derivatives are written.
struct Own<'a> {
    export: &'a str,
    prefix: &'a str,
    function: &'a Function<'a>,
}

impl Own<'_> {
    fn external(&self, name: String, inputs: Vec<Input>, calls: Vec<Call>, results: Vec<(String, Matrix)>) -> External<'_> {
        External { export: self.export, prefix: self.prefix, name, inputs, calls, results }
    }

    /// A call with the arguments of the function, and more.
    fn call(&self, calls: &Function, more: std::ops::Range<usize>) -> Call {
        let own = 0..self.function.arguments.len();
        Call { name: calls.spec.name.clone(), arguments: own.chain(more).collect(), lengths: lengths(calls) }
    }

    fn value(&self, out: &mut String) {
        let call = self.call(self.function, 0..0);
        self.external(self.function.spec.name.clone(), inputs(self.function), vec![call], results(self.function)).write(out);
    }

    /// The results of the function, as inputs that are not read.
    fn values(&self) -> Vec<Input> {
        results(self.function).into_iter().map(|(name, matrix)| Input { name: format!("out_{name}"), matrix }).collect()
    }

    /// A weight for each entry of each result.
    fn seeds(&self) -> Vec<Input> {
        let mut start = 0;
        let mut seed = |(name, mut matrix): (String, Matrix)| {
            // Each is an array of its own.
            matrix.entries.iter_mut().for_each(|entry| entry[2] -= start);
            start += matrix.rows * matrix.columns;
            Input { name: format!("adj_{name}"), matrix }
        };
        results(self.function).into_iter().map(&mut seed).collect()
    }

    /// For each result and argument the block ∂result/∂argument. CasADi numbers the entries of a
    /// matrix column by column. Its seeds leave out entries that are always zero; blocks keep them.
    fn blocks(&self, jacobian: &Function, start: usize) -> Vec<Vec<Matrix>> {
        let (zeros, arguments) = (zeros(jacobian), inputs(self.function));
        let mut at = 0;
        let mut of_result = |(_, result): &(String, Matrix)| {
            let numbers = result.rows * result.columns;
            let mut one = |argument: &Input| {
                let columns = argument.matrix.rows;
                let block = Matrix::block(&zeros, at, (result.rows, result.columns, columns));
                at += numbers * columns;
                block.moved(start)
            };
            arguments.iter().map(&mut one).collect()
        };
        results(self.function).iter().map(&mut of_result).collect()
    }

    fn jacobian(&self, out: &mut String, jacobian: &Function) {
        let arguments = inputs(self.function);
        let names = results(self.function);
        let blocks = self.blocks(jacobian, 0);
        let of = |(result, blocks): (&(String, Matrix), Vec<Matrix>)| {
            arguments.iter().zip(blocks).map(|(a, block)| (format!("jac_{}_{}", result.0, a.name), block)).collect::<Vec<_>>()
        };
        let results = names.iter().zip(blocks).flat_map(of).collect();
        let all = arguments.iter().cloned().chain(self.values()).collect();
        let call = self.call(jacobian, 0..0);
        self.external(format!("jac_{}", self.function.spec.name), all, vec![call], results).write(out);
    }

    /// Arguments, results, and seeds.
    fn inputs_of_adjoint(&self) -> (Vec<Input>, std::ops::Range<usize>) {
        let all: Vec<Input> = inputs(self.function).into_iter().chain(self.values()).chain(self.seeds()).collect();
        let first = all.len() - self.function.results.len();
        let seeds = first..all.len();
        (all, seeds)
    }

    fn adjoint(&self, out: &mut String, adjoint: &Function) {
        let (all, seeds) = self.inputs_of_adjoint();
        let (mut start, mut results) = (0, Vec::new());
        for argument in inputs(self.function) {
            let length = argument.matrix.rows;
            results.push((format!("adj_{}", argument.name), Matrix::full(length).moved(start)));
            start += length;
        }
        let call = self.call(adjoint, seeds);
        self.external(format!("adj1_{}", self.function.spec.name), all, vec![call], results).write(out);
    }

    /// The derivatives of the adjoint: the Hessian of the weighted results, and the transposed
    /// Jacobian for the weights.
    fn hessian(&self, out: &mut String, jacobian: &Function, hessian: &Function) {
        let (all, seeds) = self.inputs_of_adjoint();
        let arguments = inputs(self.function);
        let (zeros, shift) = (zeros(hessian), lengths(hessian).iter().sum::<usize>());
        let (blocks, mut at, mut results) = (self.blocks(jacobian, shift), 0, Vec::new());
        for (row, of) in arguments.iter().enumerate() {
            let rows = of.matrix.rows;
            for by in &arguments {
                results.push((format!("jac_adj_{}_{}", of.name, by.name), Matrix::of(&zeros, at, rows, by.matrix.rows)));
                at += rows * by.matrix.rows;
            }
            for value in self.values() {
                let columns = value.matrix.rows * value.matrix.columns;
                results.push((format!("jac_adj_{}_{}", of.name, value.name), Matrix { rows, columns, entries: Vec::new() }));
            }
            for (seed, blocks) in self.seeds().iter().zip(&blocks) {
                results.push((format!("jac_adj_{}_{}", of.name, seed.name), blocks[row].transposed()));
            }
        }
        let values = arguments.iter().map(|a| Input { name: format!("out_adj_{}", a.name), matrix: a.matrix.clone() });
        let all = all.into_iter().chain(values).collect();
        let calls = vec![self.call(hessian, seeds), self.call(jacobian, 0..0)];
        self.external(format!("jac_adj1_{}", self.function.spec.name), all, calls, results).write(out);
    }
}

/// Which numbers of the result are zero at every configuration.
fn zeros(function: &Function) -> Vec<bool> {
    let count: usize = function.results.iter().map(|array| array.numbers()).sum();
    let mut zeros = vec![true; count];
    let mut set = |at: usize, operand: &Operand| zeros[at] = matches!(operand, Operand::Constant(x) if *x == 0.0);
    let body = function.scalar.as_ref().map_or(&function.body, |(body, _)| body);
    for statement in body.pieces.iter().flatten() {
        match statement {
            Stmt::Region(region) => region.stores().for_each(|at| set(at, &Operand::Constant(1.0))),
            Stmt::Store(Store::Fill(at, n, x)) => (*at..at + n).for_each(|at| set(at, &Operand::Constant(*x))),
            Stmt::Store(Store::One(at, number)) | Stmt::Result(at, number) => set(*at, &number.of),
            Stmt::Store(Store::Two(at, [first, second])) => {
                set(*at, &first.of);
                set(at + 1, &second.of);
            }
            _ => {}
        }
    }
    zeros
}

/// An input of a function of the interface.
#[derive(Clone)]
struct Input {
    name: String,
    matrix: Matrix,
}

/// A call of a function of ours.
struct Call {
    name: String,
    /// The inputs that it takes.
    arguments: Vec<usize>,
    /// Lengths of the arrays that it writes; one after the other in memory.
    lengths: Vec<usize>,
}

/// One function of the interface.
struct External<'a> {
    export: &'a str,
    prefix: &'a str,
    name: String,
    inputs: Vec<Input>,
    /// The calls that compute it, whose results follow each other in memory.
    calls: Vec<Call>,
    results: Vec<(String, Matrix)>,
}

impl External<'_> {
    fn write(&self, out: &mut String) {
        let Self { export, name, .. } = self;
        let count = |n: usize, what: &str| format!("{export} long long int {name}_n_{what}(void) {{\n    return {n};\n}}\n\n");
        out.push_str(&count(self.inputs.len(), "in"));
        out.push_str(&count(self.results.len(), "out"));
        self.names(out, "in", &self.inputs.iter().map(|input| input.name.as_str()).collect::<Vec<_>>());
        self.names(out, "out", &self.results.iter().map(|result| result.0.as_str()).collect::<Vec<_>>());
        self.sparsities(out, "in", &self.inputs.iter().map(|input| input.matrix.sparsity()).collect::<Vec<_>>());
        self.sparsities(out, "out", &self.results.iter().map(|result| result.1.sparsity()).collect::<Vec<_>>());
        let _ = writeln!(
            out,
            "{export} int {name}_work(long long int *arguments, long long int *results, long long int *integers, long long int *numbers) {{\n    \
             *arguments = {};\n    *results = {};\n    *integers = 0;\n    *numbers = 0;\n    return 0;\n}}\n",
            self.inputs.len(),
            self.results.len()
        );
        self.call(out);
    }

    fn names(&self, out: &mut String, what: &str, names: &[&str]) {
        let Self { export, name, .. } = self;
        let _ = writeln!(out, "{export} const char *{name}_name_{what}(long long int k) {{\n    switch (k) {{");
        names.iter().enumerate().for_each(|(k, text)| _ = writeln!(out, "    case {k}: return \"{text}\";"));
        let _ = writeln!(out, "    default: return 0;\n    }}\n}}\n");
    }

    fn sparsities(&self, out: &mut String, what: &str, all: &[Vec<usize>]) {
        let Self { export, name, .. } = self;
        for (k, numbers) in all.iter().enumerate() {
            let text: Vec<String> = numbers.chunks(20).map(|row| row.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")).collect();
            let _ = writeln!(
                out,
                "static const long long int {name}_sparsity_{what}_{k}[{}] = {{\n    {}\n}};\n",
                numbers.len(),
                text.join(",\n    ")
            );
        }
        let _ = writeln!(out, "{export} const long long int *{name}_sparsity_{what}(long long int k) {{\n    switch (k) {{");
        (0..all.len()).for_each(|k| _ = writeln!(out, "    case {k}: return {name}_sparsity_{what}_{k};"));
        let _ = writeln!(out, "    default: return 0;\n    }}\n}}\n");
    }

    /// A table of places in an array.
    fn places(&self, out: &mut String, what: &str, matrix: &Matrix) {
        let places: Vec<String> = matrix.entries.iter().map(|entry| entry[2].to_string()).collect();
        let rows: Vec<String> = places.chunks(20).map(|row| row.join(", ")).collect();
        let _ = writeln!(out, "static const int {}_places_{what}[{}] = {{\n    {}\n}};\n", self.name, places.len(), rows.join(",\n    "));
    }

    /// Calls our functions, and copies the entries of the requested results.
    fn call(&self, out: &mut String) {
        let Self { export, prefix, name, .. } = self;
        let mut read: Vec<usize> = self.calls.iter().flat_map(|call| call.arguments.clone()).collect();
        read.sort_unstable();
        read.dedup();
        // A matrix, whose entries are in another order, becomes an array of ours.
        let turned: Vec<usize> = read.iter().copied().filter(|k| !self.inputs[*k].matrix.is_plain()).collect();
        let longest = read.iter().map(|k| self.inputs[*k].matrix.rows * self.inputs[*k].matrix.columns).max().unwrap_or(0).max(1);
        let numbers: usize = self.calls.iter().flat_map(|call| &call.lengths).sum::<usize>().max(1);
        let filled = |k: &&usize| !self.inputs[**k].matrix.entries.is_empty();
        turned.iter().filter(filled).for_each(|k| self.places(out, &format!("in_{k}"), &self.inputs[*k].matrix));
        for (k, (_, matrix)) in self.results.iter().enumerate().filter(|(_, (_, matrix))| !matrix.entries.is_empty()) {
            self.places(out, &k.to_string(), matrix);
        }
        let _ = writeln!(
            out,
            "{export} int {name}(const double **arguments, double **results, long long int *integers, double *numbers, int memory) {{\n    \
             static const double zeros[{longest}] = {{0}};\n    double own[{numbers}];\n    (void)zeros;\n    (void)integers;\n    (void)numbers;\n    (void)memory;"
        );
        for k in &turned {
            let matrix = &self.inputs[*k].matrix;
            let _ = writeln!(out, "    double seed_{k}[{}] = {{0}};", (matrix.rows * matrix.columns).max(1));
            if !matrix.entries.is_empty() {
                let _ = writeln!(
                    out,
                    "    for (int i = 0; arguments[{k}] && i < {}; i++) {{\n        \
                     seed_{k}[{name}_places_in_{k}[i]] = arguments[{k}][i];\n    }}",
                    matrix.entries.len()
                );
            }
        }
        let mut start = 0;
        for Call { name: calls, arguments, lengths } in &self.calls {
            let given = |k: &usize| match turned.contains(k) {
                true => format!("seed_{k}"),
                false => format!("arguments[{k}] ? arguments[{k}] : zeros"),
            };
            let mut list: Vec<String> = arguments.iter().map(given).collect();
            for length in lengths {
                list.push(if start == 0 { "own".to_owned() } else { format!("own + {start}") });
                start += length;
            }
            let _ = writeln!(out, "    {prefix}_{calls}({});", list.join(", "));
        }
        for (k, (_, matrix)) in self.results.iter().enumerate().filter(|(_, (_, matrix))| !matrix.entries.is_empty()) {
            let _ = writeln!(
                out,
                "    if (results[{k}]) {{\n        for (int i = 0; i < {}; i++) {{\n            results[{k}][i] = own[{name}_places_{k}[i]];\n        }}\n    }}",
                matrix.entries.len()
            );
        }
        let _ = writeln!(out, "    return 0;\n}}\n");
    }
}
