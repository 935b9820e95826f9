"""Functions of a robot on arrays of JAX, with exact derivatives for ``grad``, ``vjp`` and ``jacrev``.

>>> import articulated, articulated.jax, jax                            # doctest: +SKIP
>>> jax.config.update("jax_enable_x64", True)                           # doctest: +SKIP
>>> robot = articulated.bundled("panda_like")                           # doctest: +SKIP
>>> jax.jacrev(lambda q: articulated.jax.gravity_torque(robot, q))(robot.neutral).shape  # doctest: +SKIP
(7, 7)

Functions are calls back from JAX to the CPU. ``jit`` and ``vmap`` take them; ``vmap`` makes one call
for the batch. Without ``jax_enable_x64`` arguments, results and the computation are float32; gradients
are computed in float64 and rounded. Derivatives are first ones, in reverse mode.
"""

import functools

try:
    import jax
    import jax.numpy as jnp
except ImportError as _error:
    raise ImportError("articulated.jax: found no JAX, expected it to be installed: pip install jax") from _error

import numpy as np

from . import _gradients


@functools.lru_cache(maxsize=256)
def _function(robot, name, threads):
    """The function of arrays that have the same batch dimensions."""
    takes, gives = _gradients.sizes(robot, name)

    def value(*arguments):
        dtype, batch = arguments[0].dtype, _gradients.batch_shape(arguments, takes)
        out = jax.ShapeDtypeStruct(batch + gives, dtype)
        run = lambda *arrays: _gradients.value(robot, name, threads, arrays).astype(dtype)  # noqa: E731
        return jax.pure_callback(run, out, *arguments, vmap_method="broadcast_all")

    def backward(arguments, gradient):
        dtype = arguments[0].dtype
        out = tuple(jax.ShapeDtypeStruct(argument.shape, dtype) for argument in arguments)
        run = lambda gradient, *arrays: tuple(  # noqa: E731
            one.astype(dtype) for one in _gradients.gradients(robot, name, threads, arrays, gradient)
        )
        return jax.pure_callback(run, out, gradient, *arguments, vmap_method="broadcast_all")

    function = jax.custom_vjp(value)
    function.defvjp(lambda *arguments: (value(*arguments), arguments), backward)
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
