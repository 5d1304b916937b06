from .checking import RULES as RULES
from .checking import check as check
from .rule import Clause as Clause
from .rule import Rule as Rule
from .rule import Severity as Severity
from .rule import Verdict as Verdict
