"""Contact of sheets with each other and with themselves."""

from umform.model.contact.sheets.pair import SheetContact
from umform.model.contact.sheets.settings import SheetContactOptions

__all__ = ["SheetContact", "SheetContactOptions"]
