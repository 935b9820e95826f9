//! Names of functions that the header and the source already have.

use std::collections::BTreeSet;

use articulated_core::lanes::Real;

use super::{COptions, casadi, columns, constants, lanes, math};
use crate::FunctionSpec;

/// Why a function cannot have its name beside the others, if it cannot.
pub(in crate::language) fn refusal(function: &FunctionSpec, others: &[&FunctionSpec], c: &COptions) -> Option<String> {
    let name = function.name.as_str();
    if reserved().contains(name) {
        return Some("is a name that generated C has already: expected another name".into());
    }
    if c.casadi && is_word_of_c(name) {
        return Some("is a name of C's library or a keyword, and CasADi calls functions without a prefix: expected another name".into());
    }
    if let Some(other) = others.iter().find(|other| c.casadi && casadi::is_name_of_a_derivative(name, &other.name)) {
        return Some(format!("is a name that CasADi has for a derivative of {}: expected another name", other.name));
    }
    let is_part = |name: &str, of: &str| {
        let rest = name.strip_prefix(of).and_then(|rest| rest.strip_prefix('_')).unwrap_or_default();
        let is_piece = |rest: &str| rest.strip_prefix("piece_").is_some_and(|k| k.bytes().all(|b| b.is_ascii_digit()));
        let of_states = TYPES.iter().find_map(|real| rest.strip_prefix(&format!("lanes_{}", real.name())));
        is_piece(rest) || of_states.is_some_and(|rest| rest.is_empty() || rest.strip_prefix('_').is_some_and(is_piece))
    };
    let other = others.iter().find(|other| is_part(name, &other.name))?;
    Some(format!("is a name that generated C has for a part of {}: expected another name", other.name))
}

/// Whether it is a function of C's headers or a keyword.
pub(in crate::language) fn is_word_of_c(name: &str) -> bool {
    OF_THE_LIBRARY.split_whitespace().any(|word| word == name)
}

/// The names of helpers and constants, without the prefix.
fn reserved() -> BTreeSet<String> {
    let mut all: BTreeSet<String> = constants::NAMES.map(str::to_owned).into();
    all.extend(math::ROWS.map(|(name, ..)| name.to_owned()));
    all.extend(words_after("@P_", columns::TEXT));
    for text in lanes::TEXTS {
        all.extend(words_after("@P_", text));
        let types = TYPES.map(|real| real.name().to_owned()).into_iter().chain(["x4".into(), "x2".into()]);
        all.extend(types.flat_map(|ty| words_after("@T_", text).map(move |name| format!("{ty}_{name}"))));
    }
    all
}

/// The names in a text behind each mark.
fn words_after(mark: &str, text: &str) -> impl Iterator<Item = String> {
    let word = |rest: &str| rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
    text.split(mark).skip(1).map(word).collect::<Vec<_>>().into_iter()
}

/// Types that batches may have.
const TYPES: [Real; 2] = [Real::F64, Real::F32];

/// Functions of C's headers `math.h`, `stdlib.h`, `string.h` and `stdio.h` that are plain words,
/// and keywords.
const OF_THE_LIBRARY: &str = "abs acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh div erf erfc exp exp2 expm1 fabs fdim \
    floor fma fmax fmin fmod frexp gamma hypot ilogb j0 j1 jn labs ldexp ldiv lgamma llabs lldiv llrint llround log log10 log1p log2 logb \
    lrint lround main modf nan nearbyint nextafter nexttoward pow remainder remquo rint round scalbln scalbn sin sinh sqrt tan tanh tgamma \
    trunc y0 y1 yn abort atexit atof atoi atol bsearch calloc exit free getenv malloc qsort rand realloc srand strtod system memchr memcmp \
    memcpy memmove memset strcat strchr strcmp strcpy strlen strncpy strstr strtok clearerr fclose fopen fprintf fputc fputs fread fwrite \
    getc getchar gets perror printf putc putchar puts remove rename rewind scanf signal sprintf sscanf time tmpfile ungetc auto break case \
    char const continue default do double else enum extern float for goto if inline int long register restrict return short signed sizeof \
    static struct switch typedef union unsigned void volatile while";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Request, Target, generate};

    const PENDULUM: &str = r#"<robot name="pendulum"><link name="base"/><link name="bob"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
        <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial></link>
        <joint name="swing" type="continuous"><parent link="base"/><child link="bob"/><axis xyz="0 1 0"/></joint></robot>"#;

    fn found(functions: &[&str], c: COptions) -> String {
        let mut request = Request::new("pendulum.urdf", PENDULUM);
        request.options.functions = functions.iter().map(|text| (*text).into()).collect();
        request.options.batch = if c.casadi { vec![] } else { TYPES.to_vec() };
        request.options.target = Target::C(c);
        generate(&request).map_or_else(|error| error.to_string(), |_| String::new())
    }

    #[test]
    fn a_function_cannot_have_the_name_of_a_helper_or_of_a_constant() {
        for name in "neutral q_lower tau_limit columns sin_cos_of_four joint sqrt sin_cos f64_load f32_gather x4_v x2_m columns_row atan2f"
            .split_whitespace()
        {
            let found = found(&[&format!("{name} = inverse_dynamics")], COptions::default());
            assert!(found.contains(&format!("`{name}` is a name that generated C has already")), "{name}: {found}");
        }
        for name in ["type", "out", "robot", "lanes", "sine"] {
            assert_eq!(found(&[&format!("{name} = inverse_dynamics")], COptions::default()), "");
        }
    }

    #[test]
    fn a_function_cannot_have_the_name_of_a_part_of_another() {
        for part in ["x_piece_0", "x_lanes_f64", "x_lanes_f32_piece_12"] {
            let found = found(&["x = inverse_dynamics", &format!("{part} = mass_matrix")], COptions::default());
            assert!(found.contains("a name that generated C has for a part of x"), "{part}: {found}");
        }
        assert_eq!(found(&["x = inverse_dynamics", "x_piece = mass_matrix", "x_lanes = gravity_torque"], COptions::default()), "");
    }

    #[test]
    fn a_function_of_casadi_cannot_have_the_name_of_one_of_the_library() {
        let casadi = COptions { casadi: true, ..COptions::default() };
        for name in ["gamma", "exp", "double", "main"] {
            assert!(found(&[&format!("{name} = inverse_dynamics")], casadi.clone()).contains("a name of C's library"), "{name}");
            assert_eq!(found(&[&format!("{name} = inverse_dynamics")], COptions::default()), "");
        }
    }

    /// Each helper is refused, so no list of names can be out of date.
    #[test]
    fn the_names_of_the_table_of_functions_are_free() {
        let reserved = reserved();
        assert!(reserved.len() > 40, "{reserved:?}");
        assert!(articulated_core::algorithm::functions::<f64>().iter().all(|f| !reserved.contains(f.name)));
    }
}
