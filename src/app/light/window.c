#include "app/light/window.h"

#include <SDL.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

struct window {
	SDL_Window *window;
	SDL_Renderer *renderer;
	SDL_Texture *texture;
};

int window_create(struct window **out, const struct config_projector *projector, char *err, size_t err_size)
{
	int width = projector->width, height = projector->height;
	*out = NULL;
	struct window *w = calloc(1, sizeof *w);
	if (!w) {
		snprintf(err, err_size, "out of memory");
		return -ENOMEM;
	}
	SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
	uint32_t flags = projector->fullscreen ? SDL_WINDOW_FULLSCREEN_DESKTOP : SDL_WINDOW_RESIZABLE;
	if (SDL_InitSubSystem(SDL_INIT_VIDEO) == 0) {
		w->window = SDL_CreateWindow("billiard-projector", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
					     width, height, flags);
		w->renderer = w->window ? SDL_CreateRenderer(w->window, -1, 0) : NULL;
		w->texture = w->renderer ? SDL_CreateTexture(w->renderer, SDL_PIXELFORMAT_RGB888,
							     SDL_TEXTUREACCESS_STREAMING, width, height)
					 : NULL;
	}
	if (!w->texture) {
		snprintf(err, err_size, "no display: %s", SDL_GetError());
		window_destroy(w);
		return -ENODEV;
	}
	SDL_ShowCursor(projector->fullscreen ? SDL_DISABLE : SDL_ENABLE);
	*out = w;
	return 0;
}

void window_destroy(struct window *w)
{
	if (!w)
		return;
	if (w->texture)
		SDL_DestroyTexture(w->texture);
	if (w->renderer)
		SDL_DestroyRenderer(w->renderer);
	if (w->window)
		SDL_DestroyWindow(w->window);
	SDL_QuitSubSystem(SDL_INIT_VIDEO);
	free(w);
}

void window_show(struct window *w, const uint32_t *pixels, int stride)
{
	SDL_UpdateTexture(w->texture, NULL, pixels, stride);
	SDL_RenderCopy(w->renderer, w->texture, NULL, NULL);
	SDL_RenderPresent(w->renderer);
}

/* Keys of thesis 4.8. */
static const struct {
	SDL_Keycode key;
	const char *command, *argument;
} keys[] = {
	{SDLK_h, "halo", ""},
	{SDLK_t, "table", ""},
	{SDLK_q, "paths", ""},
	{SDLK_d, "info", ""},
	{SDLK_m, "infinity", ""},
	{SDLK_k, "animation", ""},
	{SDLK_SPACE, "animation-stop", ""},
	{SDLK_RETURN, "animation-restart", ""},
	{SDLK_LEFT, "animation-seek", "-0.5"},
	{SDLK_RIGHT, "animation-seek", "0.5"},
	{SDLK_UP, "previous", ""},
	{SDLK_DOWN, "next", ""},
};

const char *window_command(struct window *w, const char **argument, bool *quit)
{
	(void)w;
	SDL_Event event;
	while (SDL_PollEvent(&event)) {
		if (event.type == SDL_QUIT)
			*quit = true;
		if (event.type != SDL_KEYDOWN || event.key.repeat)
			continue;
		for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
			if (event.key.keysym.sym == keys[i].key) {
				*argument = keys[i].argument;
				return keys[i].command;
			}
		}
	}
	return NULL;
}
