"""The voice: text with tags is read into sentences, engines make sound of them, the loudspeakers play them."""
