"""What NaoVision sees: objects, landmarks, faces; and following them."""
