"""Changes between steps: supports removed, tools opened, gaps kept."""
