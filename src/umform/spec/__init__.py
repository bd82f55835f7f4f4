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

from umform.spec.display import ParametersInNotebook
from umform.spec.in_deck import InDeck, OneOf, deck_keys, entries, note_of
from umform.spec.parameter import About, FieldOf, Parameter, declared, hint_of, parameters, sentences
from umform.spec.paths import Scalar, changed, each, listed, scalars
from umform.spec.rule import Checked, Rule, check_arguments, check_fields, check_value
from umform.spec.takes import takes
from umform.spec.words import names_its_words

__all__ = [
    "About",
    "Checked",
    "FieldOf",
    "InDeck",
    "OneOf",
    "Parameter",
    "ParametersInNotebook",
    "Rule",
    "Scalar",
    "changed",
    "check_arguments",
    "check_fields",
    "check_value",
    "deck_keys",
    "declared",
    "each",
    "entries",
    "hint_of",
    "listed",
    "names_its_words",
    "note_of",
    "parameters",
    "scalars",
    "sentences",
    "takes",
]
