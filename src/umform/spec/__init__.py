"""Specs: dataclasses whose fields say once what a parameter may be; every front end reads them.

A field has a type with bounds, a default, and one sentence, the string below it. `About` adds the unit and the likely
mistake to a type, and `umform.spec.types` has the usual types:

    @dataclass(frozen=True)
    class VDie:
        opening: Length = 16.0
        '''Distance of the lines where the flanks meet the top.'''

`parameters` reads the fields, and `check_fields` refuses invalid values. The modules of Specs import no NumPy, so that
the help of a command starts quickly.
"""

from umform.spec.parameter import About, Parameter, parameters, sentences
from umform.spec.paths import Scalar, changed, scalars
from umform.spec.rule import Rule, check_fields, check_value

__all__ = [
    "About",
    "Parameter",
    "Rule",
    "Scalar",
    "changed",
    "check_fields",
    "check_value",
    "parameters",
    "scalars",
    "sentences",
]
