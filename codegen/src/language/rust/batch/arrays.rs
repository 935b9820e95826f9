//! Arguments and results of a batch.

use articulated_core::algorithm::{Dim, Shape};

use crate::lir::function::Function;

/// An argument or a result, one for each state.
pub(super) struct Array {
    pub(super) name: String,
    /// How long it is, and each of its elements, as expressions.
    lengths: Vec<String>,
    /// How many numbers.
    pub(super) numbers: usize,
    /// Whether one may serve for all states.
    pub(super) is_parameters: bool,
}

impl Array {
    fn new(name: &str, dims: &[Dim], sizes: Shape) -> Self {
        let lengths = dims.iter().map(Dim::to_string).collect();
        Self { name: name.to_owned(), lengths, numbers: dims.iter().map(|d| d.len(sizes)).product(), is_parameters: false }
    }

    /// The parameters, if any; their number is a named constant.
    fn parameters(name: &str) -> Self {
        Self { name: name.to_owned(), lengths: vec!["PARAMETERS.len()".into()], numbers: 1, is_parameters: true }
    }

    /// How many numbers, as an expression.
    pub(super) fn len(&self) -> String {
        if self.lengths.is_empty() { "1".into() } else { self.lengths.join(" * ") }
    }

    /// Its type for one state or block.
    pub(super) fn nested(&self, of: &str) -> String {
        self.lengths.iter().rev().fold(of.to_owned(), |inner, length| format!("[{inner}; {length}]"))
    }

    /// Gathers the numbers of `states` into its block, unless one set serves for all.
    pub(super) fn gathered(&self, states: &str) -> String {
        let Self { name, is_parameters, .. } = self;
        let gather = format!("            gather({states}, &mut {name}_block);\n");
        if *is_parameters { format!("            if {name}.len() != 1 {{\n    {gather}            }}\n") } else { gather }
    }

    /// The slice of all states as a slice of flat arrays.
    pub(super) fn flat(&self, mutable: bool) -> String {
        let m = if mutable { "_mut" } else { "" };
        match self.lengths.len() {
            0 => format!("{}.as_chunks{m}::<1>().0", self.name),
            1 => self.name.clone(),
            n => format!("{}{}.as_chunks{m}::<{{ {} }}>().0", self.name, format!(".as_flattened{m}()").repeat(n), self.len()),
        }
    }
}

/// The arguments of a function.
pub(super) fn inputs(function: &Function) -> Vec<Array> {
    let array = |a: &crate::lir::function::Argument| {
        if a.is_parameters() { Array::parameters(a.name) } else { Array::new(a.name, &a.dims, function.shape) }
    };
    function.arguments.iter().map(array).collect()
}

/// The results of a function.
pub(super) fn results(function: &Function) -> Vec<Array> {
    let outputs = &function.outputs;
    let name = |own: &'static str| if outputs.len() == 1 { "out" } else { own };
    outputs.iter().map(|output| Array::new(name(output.name), &output.dims, function.shape)).collect()
}

/// A text for each array, with its name in the place of `NAME`, its number of numbers in that of
/// `LEN`, and in that of `AT` where it is for block k.
pub(super) fn each(arrays: &[Array], text: &str) -> String {
    let at = |a: &Array| if a.is_parameters { format!("if {}.len() == 1 {{ 0 }} else {{ k }}", a.name) } else { "k".to_owned() };
    arrays.iter().map(|a| text.replace("AT", &at(a)).replace("NAME", &a.name).replace("LEN", &a.len())).collect()
}
