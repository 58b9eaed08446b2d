"""What stands around the robots: world files and the objects, marks, people and sounds they name."""
