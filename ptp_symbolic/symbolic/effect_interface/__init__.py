"""What an effect is made of: parameters, its place, what it adds, and where it holds."""
