"""Functions of a robot on tensors of PyTorch, with exact first and second derivatives for ``backward``.

>>> import articulated, articulated.torch, torch                        # doctest: +SKIP
>>> robot = articulated.bundled("panda_like")                           # doctest: +SKIP
>>> q = torch.zeros(7, dtype=torch.float64, requires_grad=True)         # doctest: +SKIP
>>> articulated.torch.gravity_torque(robot, q).sum().backward()         # doctest: +SKIP

Tensors are of float64 or float32 on the CPU, and shared with NumPy without a copy. Functions of
tensors of float32 compute in float32; gradients are computed in float64 and rounded. A derivative is
traced when it is first needed. A third derivative is an error.
"""

import numpy as np

try:
    import torch
except ImportError as _error:
    raise ImportError("articulated.torch: found no PyTorch, expected it to be installed: pip install torch") from _error

from . import _gradients


class _Function(torch.autograd.Function):
    @staticmethod
    def forward(ctx, robot, name, threads, *tensors):
        ctx.of = robot, name, threads
        ctx.save_for_backward(*tensors)
        return torch.from_numpy(_gradients.value(robot, name, threads, [tensor.detach().numpy() for tensor in tensors]))

    @staticmethod
    def backward(ctx, gradient):
        found = _Gradients.apply(*ctx.of, gradient, *ctx.saved_tensors)
        needed = ctx.needs_input_grad[3:]
        return None, None, None, *(one if is_needed else None for one, is_needed in zip(found, needed))


def _numbers(tensors):
    return [tensor.detach().numpy() for tensor in tensors]


class _Gradients(torch.autograd.Function):
    """The gradients of a function: a node of its own, which has derivatives."""

    @staticmethod
    def forward(ctx, robot, name, threads, gradient, *tensors):
        ctx.of = robot, name, threads
        ctx.save_for_backward(gradient, *tensors)
        found = _gradients.gradients(robot, name, threads, _numbers(tensors), gradient.detach().numpy())
        return tuple(torch.from_numpy(one).to(tensor.dtype) for one, tensor in zip(found, tensors))

    @staticmethod
    def backward(ctx, *directions):
        gradient, *tensors = ctx.saved_tensors
        directions = [torch.zeros_like(tensor) if one is None else one for one, tensor in zip(directions, tensors)]
        found = _Second.apply(*ctx.of, gradient, len(tensors), *tensors, *directions)
        return None, None, None, *found


class _Second(torch.autograd.Function):
    """Derivatives of gradients: a node of its own, so that their derivatives are an error, not zero."""

    @staticmethod
    def forward(ctx, robot, name, threads, gradient, count, *tensors):
        ctx.of = name
        arguments, directions = tensors[:count], tensors[count:]
        first, second = _gradients.second(robot, name, threads, _numbers(arguments), gradient.detach().numpy(), _numbers(directions))
        found = zip([first, *second], [gradient, *arguments])
        return tuple(torch.from_numpy(np.ascontiguousarray(one)).to(tensor.dtype) for one, tensor in found)

    @staticmethod
    def backward(ctx, *_):
        raise NotImplementedError(f"articulated.torch.{ctx.of}: found a third derivative, expected first and second ones")


def _tensor(name, value):
    if not isinstance(value, torch.Tensor):
        try:
            return torch.as_tensor(value, dtype=torch.float64)
        except (TypeError, ValueError, RuntimeError) as error:
            raise TypeError(f"{name}: found {type(value).__name__} ({error}), expected a tensor") from None
    if value.dtype not in (torch.float64, torch.float32) or value.device.type != "cpu" or value.layout != torch.strided:
        found = f"{value.dtype} on {value.device}, {value.layout}"
        raise TypeError(f"{name}: found {found}, expected a dense tensor of torch.float64 or float32 on the CPU: {name}.double().cpu()")
    return value


def _wrapper(name):
    def function(robot, *arguments, threads=None, **named):
        takes, _ = _gradients.sizes(robot, name)
        arguments = _gradients.in_order(name, arguments, named)
        tensors = [_tensor(argument, value) for (argument, _), value in zip(takes, arguments)]
        batch = _gradients.batch_shape(tensors, takes)
        # Float32 beside float64 is float64, as in PyTorch. It sums the gradients of broadcast
        # arguments.
        dtype = torch.float64 if any(tensor.dtype == torch.float64 for tensor in tensors) else torch.float32
        tensors = [tensor.to(dtype) for tensor in tensors]
        return _Function.apply(robot, name, threads, *(tensor.expand(batch + shape) for tensor, (_, shape) in zip(tensors, takes)))

    return _gradients.document(function, name, "Tensors of float64 or float32 on the CPU")


for _name in _gradients.RULES:
    globals()[_name] = _wrapper(_name)

__all__ = list(_gradients.RULES)


def __getattr__(name):
    return _gradients.rule(__name__, name)
