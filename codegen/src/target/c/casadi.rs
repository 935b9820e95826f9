//! The interface of CasADi's `external`: each function under its own name, with the sizes and the
//! sparsity of its arguments and results.
//!
//! A result of several dimensions is a matrix: the last dimension has its columns. CasADi's
//! matrices go column by column, ours row by row, so results are copied. Entries that are zero
//! at every configuration are left out.
//!
//! `jac_f` is there for a function f whose derivatives `f_derivatives` are in the module, of a
//! robot whose rates are the derivatives of its coordinates.

use std::fmt::Write;

use crate::lir::function::Function;
use crate::lir::{Operand, Stmt, Store};

/// A matrix whose entries are somewhere in an array of ours.
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

/// The functions of the interface, for all functions of the module.
pub(super) fn write(out: &mut String, prefix: &str, functions: &[Function]) {
    let _ = writeln!(out, "/* The interface of CasADi's external. */\n");
    let export = format!("{}_EXPORT", prefix.to_ascii_uppercase());
    let _ = writeln!(
        out,
        "#if defined(_WIN32)\n#define {export} __declspec(dllexport)\n#elif defined(__GNUC__)\n\
         #define {export} __attribute__((visibility(\"default\")))\n#else\n#define {export}\n#endif\n"
    );
    for function in functions {
        let inputs = inputs(function);
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
        let lengths: Vec<usize> = function.results.iter().map(|a| a.numbers()).collect();
        External {
            export: &export,
            prefix,
            name: &function.spec.name,
            calls: &function.spec.name,
            inputs: &inputs,
            unread: 0,
            lengths,
            results,
        }
        .write(out);
        if let Some(derivatives) = functions.iter().find(|f| f.spec.name == format!("{}_derivatives", function.spec.name)) {
            jacobian(out, &export, prefix, function, derivatives, &inputs);
        }
    }
}

/// Names and lengths of the arguments.
fn inputs(function: &Function) -> Vec<(String, usize)> {
    let length = |a: &crate::lir::function::Argument| a.dims.iter().map(|d| d.len(function.shape)).product();
    function.arguments.iter().map(|a| (a.name.to_owned(), length(a))).collect()
}

/// `jac_f`: a block for each argument, from the derivatives `[arguments][nv][nv]`.
fn jacobian(out: &mut String, export: &str, prefix: &str, of: &Function, derivatives: &Function, inputs: &[(String, usize)]) {
    let (nq, nv) = (of.shape.nq, of.shape.nv);
    let same = derivatives.arguments.iter().map(|a| a.name).eq(of.arguments.iter().map(|a| a.name));
    let numbers: usize = derivatives.results.iter().map(|a| a.numbers()).sum();
    if nq != nv || !same || of.results.len() != 1 || numbers != inputs.len() * nv * nv {
        return;
    }
    let zeros = zeros(derivatives);
    let block = |(k, (name, _)): (usize, &(String, usize))| (format!("jac_out_{name}"), Matrix::of(&zeros, k * nv * nv, nv, nv));
    let results = inputs.iter().enumerate().map(block).collect();
    let all: Vec<(String, usize)> = inputs.iter().cloned().chain([("out_out".to_owned(), nv)]).collect();
    let name = format!("jac_{}", of.spec.name);
    External { export, prefix, name: &name, calls: &derivatives.spec.name, inputs: &all, unread: 1, lengths: vec![numbers], results }
        .write(out);
}

/// Which numbers of the result are zero at every configuration.
fn zeros(function: &Function) -> Vec<bool> {
    let count: usize = function.results.iter().map(|array| array.numbers()).sum();
    let mut zeros = vec![true; count];
    let mut set = |at: usize, operand: &Operand| zeros[at] = matches!(operand, Operand::Constant(x) if *x == 0.0);
    let body = function.scalar.as_ref().map_or(&function.body, |(body, _)| body);
    for statement in body.pieces.iter().flatten() {
        match statement {
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

/// One function of the interface.
struct External<'a> {
    export: &'a str,
    prefix: &'a str,
    name: &'a str,
    /// The function of ours that computes it.
    calls: &'a str,
    inputs: &'a [(String, usize)],
    /// How many inputs at the end it does not read.
    unread: usize,
    /// Lengths of the arrays that our function writes; one after the other in memory.
    lengths: Vec<usize>,
    results: Vec<(String, Matrix)>,
}

impl External<'_> {
    fn write(&self, out: &mut String) {
        let Self { export, name, .. } = self;
        let count = |n: usize, what: &str| format!("{export} long long int {name}_n_{what}(void) {{\n    return {n};\n}}\n\n");
        out.push_str(&count(self.inputs.len(), "in"));
        out.push_str(&count(self.results.len(), "out"));
        self.names(out, "in", &self.inputs.iter().map(|input| input.0.as_str()).collect::<Vec<_>>());
        self.names(out, "out", &self.results.iter().map(|result| result.0.as_str()).collect::<Vec<_>>());
        self.sparsities(out, "in", &self.inputs.iter().map(|input| vec![input.1, 1, 1]).collect::<Vec<_>>());
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

    /// Calls our function, and copies the entries of the requested results.
    fn call(&self, out: &mut String) {
        let Self { export, prefix, name, calls, .. } = self;
        let read = &self.inputs[..self.inputs.len() - self.unread];
        let longest = read.iter().map(|input| input.1).max().unwrap_or(0).max(1);
        let numbers: usize = self.lengths.iter().sum::<usize>().max(1);
        for (k, (_, matrix)) in self.results.iter().enumerate().filter(|(_, (_, matrix))| !matrix.entries.is_empty()) {
            let places: Vec<String> = matrix.entries.iter().map(|entry| entry[2].to_string()).collect();
            let rows: Vec<String> = places.chunks(20).map(|row| row.join(", ")).collect();
            let _ = writeln!(out, "static const int {name}_places_{k}[{}] = {{\n    {}\n}};\n", places.len(), rows.join(",\n    "));
        }
        let _ = writeln!(
            out,
            "{export} int {name}(const double **arguments, double **results, long long int *integers, double *numbers, int memory) {{\n    \
             static const double zeros[{longest}] = {{0}};\n    double own[{numbers}];\n    (void)integers;\n    (void)numbers;\n    (void)memory;"
        );
        let mut list: Vec<String> = (0..read.len()).map(|k| format!("arguments[{k}] ? arguments[{k}] : zeros")).collect();
        let mut start = 0;
        for length in &self.lengths {
            list.push(if start == 0 { "own".to_owned() } else { format!("own + {start}") });
            start += length;
        }
        let _ = writeln!(out, "    {prefix}_{calls}({});", list.join(", "));
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
