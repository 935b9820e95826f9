"""Functions of a robot on arrays of JAX, with exact derivatives in reverse and forward mode.

>>> import articulated, articulated.jax, jax                            # doctest: +SKIP
>>> jax.config.update("jax_enable_x64", True)                           # doctest: +SKIP
>>> robot = articulated.bundled("panda_like")                           # doctest: +SKIP
>>> jax.jacrev(lambda q: articulated.jax.gravity_torque(robot, q))(robot.neutral).shape  # doctest: +SKIP
(7, 7)

Functions are calls back from JAX to the CPU. ``jit`` and ``vmap`` take them; ``vmap`` makes one call
for the batch. Without ``jax_enable_x64`` arguments, results and the computation are float32; gradients
are computed in float64 and rounded. A derivative is traced when it is first needed. Second derivatives
are those of forward mode over reverse mode, as ``jax.hessian`` takes them; others are errors.
"""

import functools

try:
    import jax
    import jax.numpy as jnp
    from jax.extend.core import Primitive
    from jax.interpreters import ad, batching, mlir
except ImportError as _error:
    raise ImportError("articulated.jax: found no JAX, expected it to be installed: pip install jax") from _error

import numpy as np

from . import _gradients


def _value(*arguments, of):
    """The function, on arrays that have the same batch dimensions."""
    robot, name, threads = of
    takes, gives = _gradients.sizes(robot, name)
    dtype, batch = arguments[0].dtype, _gradients.batch_shape(arguments, takes)
    run = lambda *arrays: _gradients.value(robot, name, threads, arrays).astype(dtype)  # noqa: E731
    return jax.pure_callback(run, jax.ShapeDtypeStruct(batch + gives, dtype), *arguments, vmap_method="broadcast_all")


def _shape(arguments, of):
    """The shape of the result along directions, which come after as many arguments."""
    robot, name, _ = of
    takes, gives = _gradients.sizes(robot, name)
    return _gradients.batch_shape(arguments, [*takes, *takes]) + gives


def _directed(*arguments, of):
    """The derivative of the function along directions."""
    robot, name, threads = of
    half, dtype = len(arguments) // 2, arguments[0].dtype
    run = lambda *arrays: _gradients.along(robot, name, threads, arrays[:half], arrays[half:]).astype(dtype)  # noqa: E731
    return jax.pure_callback(run, jax.ShapeDtypeStruct(_shape(arguments, of), dtype), *arguments, vmap_method="broadcast_all")


def _gradients_of(gradient, *arguments, of):
    """The transposed derivative: gradients of the arguments."""
    return _callback(_gradients.gradients, arguments, gradient, (), of)


def _curved(gradient, arguments, directions, of):
    """The derivative of these gradients along directions of the arguments: a symmetric matrix times the directions."""
    return _callback(lambda *all_of_it: _gradients.second(*all_of_it)[1], arguments, gradient, directions, of)


def _callback(function, arguments, gradient, directions, of):
    """An array for each argument, of a function of a gradient of the result."""
    robot, name, threads = of
    takes, gives = _gradients.sizes(robot, name)
    ports = [*takes, ("gradient", gives), *(takes if directions else ())]
    dtype, batch = arguments[0].dtype, _gradients.batch_shape([*arguments, gradient, *directions], ports)
    out, count = tuple(jax.ShapeDtypeStruct(batch + shape, dtype) for _, shape in takes), len(takes)

    def run(gradient, *arrays):
        more = (arrays[count:],) if directions else ()
        return tuple(one.astype(dtype) for one in function(robot, name, threads, arrays[:count], gradient, *more))

    return jax.pure_callback(run, out, gradient, *arguments, *directions, vmap_method="broadcast_all")


@functools.lru_cache(maxsize=256)
def _backward(of):
    """The transposed derivative, with a derivative in forward mode, for Hessians."""
    function = jax.custom_jvp(functools.partial(_gradients_of, of=of))

    @function.defjvp
    def _(primals, tangents):
        (gradient, *arguments), (change, *directions) = primals, tangents
        along = _curved(gradient, arguments, directions, of)
        linear = _gradients_of(change, *arguments, of=of)
        return function(*primals), tuple(one + other for one, other in zip(along, linear))

    return function


# The derivative along directions is an operation of its own, linear in the directions: JAX transposes
# it for reverse mode.
_along = Primitive("articulated_along")
_along.def_impl(_directed)
_along.def_abstract_eval(lambda *arguments, of: jax.core.ShapedArray(_shape(arguments, of), arguments[0].dtype))
mlir.register_lowering(_along, mlir.lower_fun(_directed, multiple_results=False))


def _batched(arguments, axes, *, of):
    # Functions take any batch dimensions before those of one state; all arguments have the same here.
    count = next(array.shape[axis] for array, axis in zip(arguments, axes) if axis is not None)
    whole = lambda array: jnp.broadcast_to(array, (count, *array.shape))  # noqa: E731
    moved = [whole(array) if axis is None else jnp.moveaxis(array, axis, 0) for array, axis in zip(arguments, axes)]
    return _along.bind(*moved, of=of), 0


def _transposed(gradient, *arguments, of):
    half = len(arguments) // 2
    found = _backward(of)(gradient, *arguments[:half])
    out = []
    for direction, one in zip(arguments[half:], found):
        if not ad.is_undefined_primal(direction):
            out.append(None)
            continue
        extra = tuple(range(one.ndim - len(direction.aval.shape)))
        out.append(one.sum(axis=extra))
    return [None] * half + out


def _differentiated(arguments, tangents, *, of):
    half = len(arguments) // 2
    if any(type(tangent) is not ad.Zero for tangent in tangents[:half]):
        raise NotImplementedError(f"articulated.jax.{of[1]}: found a second derivative in another order, expected forward mode over reverse mode, as jax.hessian has it")
    known = [ad.instantiate_zeros(tangent) for tangent in tangents[half:]]
    return _along.bind(*arguments, of=of), _along.bind(*arguments[:half], *known, of=of)


batching.primitive_batchers[_along] = _batched
ad.primitive_transposes[_along] = _transposed
ad.primitive_jvps[_along] = _differentiated


@functools.lru_cache(maxsize=256)
def _function(robot, name, threads):
    of = robot, name, threads
    function = jax.custom_jvp(functools.partial(_value, of=of))
    function.defjvp(lambda arguments, directions: (function(*arguments), _along.bind(*arguments, *directions, of=of)))
    return function


def _array(name, value):
    try:
        array = jnp.asarray(value)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name}: found {type(value).__name__} ({error}), expected an array of real numbers") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name}: found dtype {array.dtype}, expected real numbers, such as float64")
    return array


def _wrapper(name):
    def function(robot, *arguments, threads=None, **named):
        takes, _ = _gradients.sizes(robot, name)
        arguments = _gradients.in_order(name, arguments, named)
        arrays = [_array(argument, value) for (argument, _), value in zip(takes, arguments)]
        dtype = np.float64 if jax.config.jax_enable_x64 else np.float32
        batch = _gradients.batch_shape(arrays, takes)
        # JAX sums the gradients of broadcast arguments.
        whole = [jnp.broadcast_to(array, batch + shape).astype(dtype) for array, (_, shape) in zip(arrays, takes)]
        return _function(robot, name, threads)(*whole)

    return _gradients.document(function, name, "Arrays")


for _name in _gradients.RULES:
    globals()[_name] = _wrapper(_name)

__all__ = list(_gradients.RULES)


def __getattr__(name):
    return _gradients.rule(__name__, name)
