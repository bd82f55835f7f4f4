"""Contact of the sheet with rigid tools: pairs, what they are set to, and multipliers against penetration."""

from umform.model.contact.pair import Contact, ContactPoints, Motion, ToolMotion
from umform.model.contact.settings import ContactSettings, contact_settings

__all__ = ["Contact", "ContactPoints", "ContactSettings", "Motion", "ToolMotion", "contact_settings"]
