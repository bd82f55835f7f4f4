"""What a model is made of: terms, controls, forces, and the state at which they are evaluated."""
