"""What numba lacks: pointers to numbers and records, and exponentials without a branch."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from llvmlite import ir
from numba import extending, types
from numba import njit as _njit
from numba.core import cgutils

if TYPE_CHECKING:
    from collections.abc import Callable

    from numba.core.typing import Context, Signature

    Typed = tuple[Signature, Callable[..., ir.Value]]

__all__ = [
    "ahead",
    "exact",
    "exp",
    "inlined",
    "keep_apart",
    "normal_cdf",
    "numbers",
    "pointer",
    "record",
    "sums",
]

njit: Any = _njit
intrinsic: Any = extending.intrinsic
"""Untyped: what they make is called with other arguments than it is written with."""

SUM = {"nnan", "ninf", "nsz", "arcp", "contract", "reassoc"}
"""Sums may be reordered into vectors; inputs are finite."""
EXACT = {"nnan", "ninf", "nsz", "contract"}
"""Where the order of operations carries the meaning."""

INNER = {"error_model": "numpy", "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Options of functions that only the kernels call."""
exact, sums = njit(fastmath=EXACT, **INNER), njit(fastmath=SUM, **INNER)
inlined = njit(fastmath=EXACT, inline="always", **INNER)
"""What one function alone calls, compiled as a part of it: apart, it would be optimised twice."""


@intrinsic
def _bits(typingctx: Context, x: types.Type) -> Typed:
    """The 64 bits of a float as an integer."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), codegen


@intrinsic
def _float(typingctx: Context, n: types.Type) -> Typed:
    """The float with these 64 bits."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), codegen


@intrinsic
def pointer(typingctx: Context, array: types.Array) -> Typed:
    """To the first number or record of a contiguous array, which the caller keeps alive."""

    def codegen(context, builder, signature, args):
        return context.make_array(signature.args[0])(context, builder, args[0]).data

    return types.CPointer(array.dtype)(array), codegen


@intrinsic
def ahead(typingctx: Context, pointer: types.CPointer, n: types.Type) -> Typed:
    """The pointer n numbers or records ahead."""

    def codegen(context, builder, signature, args):
        return builder.gep(args[0], [args[1]])

    return pointer(pointer, types.intp), codegen


@intrinsic
def record(typingctx: Context, pointer: types.CPointer, n: types.Type) -> Typed:
    """The record n records ahead."""

    def codegen(context, builder, signature, args):
        return builder.gep(args[0], [args[1]])

    return pointer.dtype(pointer, types.intp), codegen


@extending.intrinsic(prefer_literal=True)
def numbers(typingctx: Context, record: types.Record, name: types.StringLiteral) -> Typed:
    """To the first of the numbers in a field of a record, by its name."""
    field, number = record.fields[name.literal_value], types.float64

    def codegen(context, builder, signature, args):
        pointee = context.get_data_type(number)
        return cgutils.get_record_member(builder, args[0], field.offset, pointee)

    return types.CPointer(number)(record, name), codegen


@intrinsic
def keep_apart(typingctx: Context) -> Typed:
    """Keep the function that calls this one: optimised once, not again in each caller."""

    def codegen(context, builder, signature, args):
        builder.function.attributes.add("noinline")
        return context.get_dummy_value()

    return types.none(), codegen


LOG2E = 1.4426950408889634
LN2_HIGH = 6.93147180369123816490e-01
LN2_LOW = 1.90821492927058770002e-10
MAGIC = 6755399441055744.0


@njit(fastmath=EXACT, inline="never", error_model="numpy")
def exp(x):
    """exp(x) for −700 < x < 700 without a branch, so that loops over it become vectors.

    x = n ln 2 + r with |r| ≤ ln 2/2; exp(r) by its Taylor polynomial, 2^n by its bits. Relative
    error 3e-16.
    """
    z = x * LOG2E + MAGIC
    n = z - MAGIC
    r = (x - n * LN2_HIGH) - n * LN2_LOW
    p = 1.6059043836821613e-10
    p = p * r + 2.08767569878681e-09
    p = p * r + 2.505210838544172e-08
    p = p * r + 2.755731922398589e-07
    p = p * r + 2.7557319223985893e-06
    p = p * r + 2.48015873015873e-05
    p = p * r + 0.0001984126984126984
    p = p * r + 0.001388888888888889
    p = p * r + 0.008333333333333333
    p = p * r + 0.041666666666666664
    p = p * r + 0.16666666666666666
    p = p * r + 0.5
    p = p * r + 1.0
    p = p * r + 1.0
    return p * _float((_bits(z) << 52) + 4607182418800017408)


@njit(fastmath=EXACT, inline="never", error_model="numpy")
def normal_cdf(z, density):
    """Φ(z) = ½ erfc(−z/√2), where ``density`` is exp(−z²/2), without a branch.

    (1 + 2x) exp(x²) erfc(x), x = |z|/√2, is a polynomial in (x − 3.75)/(x + 3.75): its Chebyshev
    series of degree 22, from sixty digits. Relative error 1e-15 for z < 0.
    """
    x = abs(z) / math.sqrt(2)
    s = (x - 3.75) / (x + 3.75)
    p = -2.623107347133476e-09
    p = p * s - 1.9551358868985616e-09
    p = p * s + 3.197926671666804e-08
    p = p * s + 1.879082322370048e-08
    p = p * s - 2.4857126248016745e-07
    p = p * s - 5.084465378687302e-08
    p = p * s + 1.7419821586224816e-06
    p = p * s - 9.792625707303523e-07
    p = p * s - 1.1438048033346894e-05
    p = p * s + 2.2387565714911816e-05
    p = p * s + 5.164652974177416e-05
    p = p * s - 0.00029015535246077655
    p = p * s + 0.000293714378044958
    p = p * s + 0.0017556261651970652
    p = p * s - 0.009746579683265262
    p = p * s + 0.02836227737211114
    p = p * s - 0.05869339857664934
    p = p * s + 0.09230432116428125
    p = p * s - 0.10880393014244462
    p = p * s + 0.08227673848999506
    p = p * s + 0.0035854154854790257
    p = p * s - 0.14024059858554525
    p = p * s + 1.2375126308378275
    tail = 0.5 * density * p / (1 + 2 * x)
    return 1 - tail if z > 0 else tail
