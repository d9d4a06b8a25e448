"""Words that are no names in exported text: one list for all languages, so that a name is the same
in each.
"""

import keyword

OF_C = """
HUGE_VAL HUGE_VALF HUGE_VALL INFINITY M_E M_PI NAN NULL _Bool _Complex _Imaginary asm auto
break case char const continue default do double else enum extern float for goto if inline
int long register restrict return short signed sizeof static struct switch typedef typeof
union unsigned void volatile while
"""
OF_MATH_H = """
acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1
fabs fdim floor fma fmax fmin fmod frexp gamma hypot ilogb isfinite isinf isnan j0 j1 jn
ldexp lgamma log log10 log1p log2 logb modf nan nearbyint nextafter pow remainder rint round
scalbn signbit sin sinh sqrt tan tanh tgamma trunc y0 y1 yn
"""
OF_EXPORTED_C = """
real REAL ABS MAX SMALLEST RIGID STATES INPUTS OUTPUTS PARAMETERS PREPARED MODES FRICTIONS
CONTACTS GUARDS SAMPLERS UPDATES LIMITS FRICTION_RATES ZERO_AT_REST CONTACT_RATES SAMPLED
LIMITED
"""  # types and macros of the source
OF_OCTAVE = """
Inf NA NaN abs arguments catch choice classdef double e elseif end end_try_catch
end_unwind_protect endclassdef endfor endfunction endif endparfor endswitch endwhile
enumeration eps events function global i inf j max methods min nan otherwise parfor
persistent pi properties sign spmd try until unwind_protect unwind_protect_cleanup
"""
OF_PYTHON = frozenset(keyword.kwlist) | {"ca", "jax", "jnp", "np", "math"}
_MATH = frozenset(OF_MATH_H.split())
WORDS = frozenset(" ".join([OF_C, OF_EXPORTED_C, OF_OCTAVE]).split())
WORDS |= _MATH | {f"{word}f" for word in _MATH} | OF_PYTHON
