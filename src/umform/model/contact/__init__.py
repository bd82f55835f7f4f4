"""Contact of the sheet with rigid tools: pairs, their settings, and results at their points."""

from umform.model.contact.found import ContactFound, ContactPoints
from umform.model.contact.pair import Contact
from umform.model.contact.settings import ContactOptions, ContactSettings, contact_settings

__all__ = ["Contact", "ContactFound", "ContactOptions", "ContactPoints", "ContactSettings", "contact_settings"]
