"""Self-contained HTML reports: one page, no network."""
